#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "../../laboratory/score.hpp"
#include "laboratory.hpp"

using namespace vines;
using namespace vines::test;

TEST_CASE(
    "an impact just before the end of the record does not spoil the others' times, and its "
    "unknown velocity is left out") {
    Experiment e = measured(0.015, 0.85, 0.85, {.rate = 1024, .pulse = 1.2e-3});
    // Ends a third of a step after an impact.
    const double step = e.omega0 / 1024;
    std::size_t cut = 0, impact = 0;
    for (std::size_t i = e.impacts.size() / 2; i < e.impacts.size() && cut == 0; ++i) {
        const std::size_t after = first_index(e.record, e.impacts[i].tau);
        const double since = (e.record.tau[after] - e.impacts[i].tau) / step;
        if (since > 0.2 && since < 0.4) cut = after + 1, impact = i;
    }
    REQUIRE(cut > 0);
    for (std::vector<double>* v : {&e.record.tau, &e.record.x, &e.record.x_ddot}) v->resize(cut);
    e.impacts.resize(impact + 1);
    const MeasurementResult r = identified(e);
    CHECK(score_of(e, r).within_100_us > 0.98);
    const IdentifiedImpact& last = r.found.impacts.back();
    REQUIRE(std::abs(last.tau - e.impacts.back().tau) < step);
    CHECK(std::isnan(last.x_dot_after));
    CHECK(last.x_dot_before == doctest::Approx(e.impacts.back().x_dot_before).epsilon(0.02));
}

TEST_CASE(
    "each impact has a standard error of its time that covers the truth" *
    doctest::test_suite("long")) {
    struct Case {
        double rate, pulse, most_us;
    };
    for (const Case& c :
         {Case{2048, 0.3e-3, 30}, Case{2048, 0.8e-3, 15}, Case{8192, 0.3e-3, 8},
          Case{2048, 3e-3, 15}}) {
        CAPTURE(c.rate);
        CAPTURE(c.pulse);
        const Experiment e =
            measured(settled_motion(0.015, 0.85, 0.85, 12), {.rate = c.rate, .pulse = c.pulse});
        const MeasurementResult r = identified(e);
        double squares = 0;
        std::vector<double> errors;
        for (const IdentifiedImpact& i : r.found.impacts) {
            double off = infinity;
            for (const Impact& truth : e.impacts)
                if (std::abs(i.tau - truth.tau) < std::abs(off)) off = i.tau - truth.tau;
            const double sigmas = off / i.tau_error;
            squares += std::min(sigmas * sigmas, 25.0);
            errors.push_back(1e6 * i.tau_error / e.omega0);
        }
        const double rms = std::sqrt(squares / static_cast<double>(errors.size()));
        CHECK(rms > 0.4);
        CHECK(rms < 1.7);
        CHECK(median(errors) < c.most_us);
    }
}
