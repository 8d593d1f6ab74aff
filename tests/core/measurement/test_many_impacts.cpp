#include <doctest/doctest.h>

#include <cmath>

#include "../../laboratory/many_impacts.hpp"
#include "../../laboratory/score.hpp"

using namespace vines;
using namespace vines::test;

namespace {

struct IdentifiedMotion {
    Experiment experiment;
    MeasurementResult result;
    Score score;
};
IdentifiedMotion identified_motion(std::uint64_t seed) {
    const auto motion = motion_with_many_impacts(seed);
    REQUIRE(motion);
    Experiment e = experiment_of(*motion);
    MeasurementResult r = identified(e);
    const Score s = score_of(e, r);
    return {std::move(e), std::move(r), s};
}

}  // namespace

TEST_CASE(
    "three to seven impacts per cycle are all found, with b and R within four errors" *
    doctest::test_suite("statistics")) {
    for (const std::uint64_t seed : {33, 56, 76, 103, 113, 117, 184}) {
        CAPTURE(seed);
        const auto [e, r, s] = identified_motion(seed);
        CHECK(100 * (s.found - s.flipped) >= 99 * s.impacts);
        CHECK(s.false_ones == 0);
        CHECK(r.judged.verdict == Verdict::regular);
        CHECK(std::abs(r.found.b_fitted - e.parameters.b) < 4 * r.found.b_error);
        CHECK(std::abs(r.found.plus.R - e.parameters.R_plus) < 4 * r.found.plus.error);
        CHECK(std::abs(r.found.minus.R - e.parameters.R_minus) < 4 * r.found.minus.error);
    }
}

TEST_CASE(
    "where impacts of a chatter are missed nothing is decided, and b and R are withheld" *
    doctest::test_suite("statistics")) {
    for (const std::uint64_t seed : {188, 455, 620}) {
        CAPTURE(seed);
        const auto [e, r, s] = identified_motion(seed);
        if (100 * s.found >= 99 * s.impacts) continue;
        CHECK(r.judged.verdict == Verdict::not_decided);
        CHECK(std::isnan(r.found.b_fitted));
        CHECK(std::isnan(r.found.plus.R));
        CHECK(std::isnan(r.found.minus.R));
    }
}
