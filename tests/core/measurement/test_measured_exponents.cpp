#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/identified_impact.hpp"
#include "core/measurement/measurement.hpp"
#include "laboratory.hpp"

using namespace vines;
using namespace vines::test;

namespace {

/// Removes a random fraction.
std::vector<IdentifiedImpact> without(const std::vector<IdentifiedImpact>& impacts, double share) {
    std::mt19937_64 engine(7);
    std::vector<IdentifiedImpact> rest;
    for (const IdentifiedImpact& i : impacts)
        if (uniform(engine, 0, 1) >= share) rest.push_back(i);
    return rest;
}

}  // namespace

TEST_CASE(
    "missing impacts hardly change lambda1, keep the sum rule and limit the product to the longest "
    "stretch") {
    for (const double b : {0.015, 0.009}) {
        CAPTURE(b);
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 100);
        const double lambda1 = motion.exponents.qr()[0];
        for (const double share : {0.0, 0.02, 0.1, 0.3}) {
            CAPTURE(share);
            std::vector<IdentifiedImpact> impacts = without(listed(motion.impacts), share);
            complete_impacts(motion.parameters, impacts, 0);
            const Continuity c = continuity_of(motion.parameters, impacts, {});
            CHECK(c.left_out == 0);
            CHECK(c.share == doctest::Approx(share).epsilon(0.35));
            const MeasuredExponents e(
                motion.parameters, given_unknowns(motion.parameters), impacts, c.stretches,
                all_estimators);
            CHECK(
                std::abs(e.all().qr()[0] - lambda1) <
                (b == 0.009 ? 3e-4 : 0.05 * lambda1 * (1 + 10 * share)));
            CHECK(e.all().sum_rule_residual() < 1e-12);
            // The clock stops at gaps: growth per impact does not depend on the thinning of the
            // history.
            CHECK(
                e.moment(e.all().end_tau()) ==
                doctest::Approx(impacts[c.stretches.back().last].tau).epsilon(1e-12));
            const IdentifiedExponents judged = judge_exponents(e, impacts);
            CHECK(judged.verdict == (b == 0.009 ? Verdict::regular : Verdict::chaotic));
            CHECK(judged.slope.value == doctest::Approx(lambda1).epsilon(b == 0.009 ? 0.05 : 0.2));
            // No product across a gap exists: these use the longest stretch.
            const KnownStretch longest =
                *std::max_element(c.stretches.begin(), c.stretches.end(), [&](auto& l, auto& r) {
                    return impacts[l.last].tau - impacts[l.first].tau <
                           impacts[r.last].tau - impacts[r.first].tau;
                });
            CHECK(e.longest().start_tau() == impacts[longest.first].tau);
            CHECK(e.longest().impacts() == static_cast<long>(longest.last - longest.first + 1));
        }
    }
}

TEST_CASE(
    "nine of ten 90 % intervals of the slope contain the long-run exponent" *
    doctest::test_suite("long")) {
    constexpr int windows = 200;
    struct Case {
        double seconds, least, most, width;
    };
    for (const Case& c : {Case{20, 0.86, 0.94, 0.040}, Case{10, 0.85, 1, 0.06}}) {
        CAPTURE(c.seconds);
        const TrueMotion motion = settled_motion(0.015, 0.85, 0.85, windows * c.seconds);
        const std::vector<IdentifiedImpact> all = listed(motion.impacts);
        const double lambda1 = motion.exponents.qr()[0];
        int held = 0;
        double width = 0;
        auto from = all.begin();
        for (int w = 1; w <= windows; ++w) {
            const double end = motion.begin + w * c.seconds * motion.omega0;
            const auto to =
                std::find_if(from, all.end(), [&](const auto& i) { return i.tau > end; });
            std::vector<IdentifiedImpact> some(from, to);
            from = to;
            complete_impacts(motion.parameters, some, 0);
            const MeasuredExponents e(
                motion.parameters, given_unknowns(motion.parameters), some,
                continuity_of(motion.parameters, some, {}).stretches, qr_alone);
            const MeasuredSlope s = e.slope();
            held += s.low < lambda1 && lambda1 < s.high;
            width += (s.high - s.low) / windows;
        }
        CHECK(held >= c.least * windows);
        CHECK(held <= c.most * windows);
        CHECK(width < c.width);
    }
}

TEST_CASE("a list of impacts without a chatter and its sticking phase is completed") {
    const TrueMotion motion = motion_after(20, 0.015, 0.5, 0.5, 20);
    std::vector<IdentifiedImpact> list = listed(motion.impacts);
    std::erase_if(list, [](const IdentifiedImpact& i) {
        return std::abs(i.x_dot_after - i.x_dot_before) < 2e-5;
    });
    const ListedForcing forcing = fit_forcing(motion.parameters, list);
    insert_missing_impacts(motion.parameters, forcing, list);
    CHECK(sticking_phases(list).size() == motion.sticks.size());
    set_flight_velocities(motion.parameters, list);
    complete_impacts(motion.parameters, list, 0);
    const MeasuredExponents exponents(
        motion.parameters, given_unknowns(motion.parameters), list,
        continuity_of(motion.parameters, list, {}).stretches, qr_alone);
    CHECK(exponents.all().qr()[0] == doctest::Approx(motion.exponents.qr()[0]).epsilon(0.01));
}

TEST_CASE("an impact missing from a chatter spoils none of the others") {
    const TrueMotion motion = motion_after(20, 0.015, 0.5, 0.5, 20);
    const Parameters& p = motion.parameters;
    const std::vector<IdentifiedImpact> all = listed(motion.impacts);
    int tried = 0;
    for (std::size_t k = 2; k + 2 < all.size(); ++k) {
        if (all[k - 1].side != all[k].side || all[k + 1].side != all[k].side) continue;
        CAPTURE(k);
        ++tried;
        std::vector<IdentifiedImpact> list = all;
        list.erase(list.begin() + static_cast<std::ptrdiff_t>(k));
        insert_missing_impacts(p, fit_forcing(p, list), list);
        set_flight_velocities(p, list);
        complete_impacts(p, list, 0);
        CHECK(std::ranges::count_if(list, &IdentifiedImpact::is_left_out) == 0);
    }
    CHECK(tried > 5);
}

TEST_CASE("impacts are inserted whichever way the damping is stated") {
    const TrueMotion motion = settled_motion(0.015, 0.85, 0.85, 100);
    Parameters doubled = motion.parameters;
    REQUIRE(doubled.damping == Damping::equation_of_motion);
    doubled.damping = Damping::closed_form, doubled.lambda *= 0.5;
    std::vector<IdentifiedImpact> list = without(listed(motion.impacts), 0.1), other = list;
    insert_missing_impacts(motion.parameters, fit_forcing(motion.parameters, list), list);
    insert_missing_impacts(doubled, fit_forcing(doubled, other), other);
    CHECK(other.size() == list.size());
}

TEST_CASE("one impact of a wall gives its R without a standard error") {
    IdentifiedImpact impact{};
    impact.side = 1, impact.R = 0.6;
    const Restitution one = restitution_of({impact}, 1);
    CHECK(one.R == 0.6);
    CHECK(std::isnan(one.error));
}

TEST_CASE("impacts missing from a list are inserted at their true times, and no others") {
    for (const double b : {0.015, 0.012, 0.009}) {
        CAPTURE(b);
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 100);
        const Parameters& p = motion.parameters;
        const std::vector<IdentifiedImpact> all = listed(motion.impacts);
        std::vector<IdentifiedImpact> list = without(all, 0.1);
        const auto dropped = static_cast<double>(all.size() - list.size());
        const ListedForcing forcing = fit_forcing(p, list);
        CHECK(G_of(p, forcing.sin, forcing.cos) == doctest::Approx(p.G).epsilon(1e-9));
        const std::size_t listed_impacts = list.size();
        insert_missing_impacts(p, forcing, list);
        CHECK(static_cast<double>(list.size() - listed_impacts) > 0.95 * dropped);
        long others = 0;
        for (const IdentifiedImpact& i : list)
            others += std::none_of(all.begin(), all.end(), [&](const IdentifiedImpact& a) {
                return std::abs(a.tau - i.tau) < 1e-5 && a.side == i.side;
            });
        CHECK(others == 0);
        set_flight_velocities(p, list);
        complete_impacts(p, list, 0);
        const MeasuredExponents e(
            p, given_unknowns(p), list, continuity_of(p, list, {}).stretches, qr_alone);
        const double lambda1 = motion.exponents.qr()[0];
        CHECK(std::abs(e.all().qr()[0] - lambda1) < 0.03 * std::abs(lambda1));
    }
}

TEST_CASE("a chaotic motion that is synchronised for a while is not called regular") {
    for (const double b : {0.011, 0.012}) {
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 200);
        const std::vector<IdentifiedImpact> all = listed(motion.impacts);
        for (const std::size_t n : {40u, 60u, 80u, 100u, 150u, 200u})
            for (std::size_t from = 0; from + n < all.size(); from += n / 2) {
                CAPTURE(n);
                CAPTURE(from);
                std::vector<IdentifiedImpact> some(
                    all.begin() + static_cast<std::ptrdiff_t>(from),
                    all.begin() + static_cast<std::ptrdiff_t>(from + n));
                complete_impacts(motion.parameters, some, 0);
                const MeasuredExponents e(
                    motion.parameters, given_unknowns(motion.parameters), some,
                    continuity_of(motion.parameters, some, {}).stretches, qr_alone);
                CHECK(judge_exponents(e, some).verdict != Verdict::regular);
            }
    }
}

TEST_CASE("a forced motion whose impacts weaken for a while is not said to die out") {
    for (const double b : {0.015, 0.018, 0.022}) {
        const TrueMotion motion = settled_motion(b, 0.85, 0.85, 200);
        const std::vector<IdentifiedImpact> all = listed(motion.impacts);
        std::size_t weakening = 0;
        for (std::size_t from = 0; from + 30 < all.size(); from += 10) {
            const auto first = all.begin() + static_cast<std::ptrdiff_t>(from);
            Measurement m{.parameters = motion.parameters, .impacts = {first, first + 30}};
            complete_impacts(m.parameters, m.impacts, 0);
            const IdentifiedExponents judged = evaluate_measurement(m).judged;
            CHECK(judged.verdict != Verdict::none);
            CHECK((!judged.weakens || judged.verdict == Verdict::not_decided));
            weakening += judged.weakens;
        }
        CHECK(weakening > 0);
    }
}

TEST_CASE(
    "impacts that die out have no long-run exponents, and negligible forcing counts as none") {
    for (const double G : {0.0, 1e-7}) {
        CAPTURE(G);
        Parameters p;
        p.G = G, p.b = 0.004;
        ImpactRecord record;
        Observer* const observers[] = {&record};
        simulate(p, {.x = 0.05, .y = 0.05}, {.tau_end = 1500}, observers);
        Measurement m{.parameters = p, .impacts = listed(record.entries)};
        complete_impacts(p, m.impacts, 0);
        CHECK(evaluate_measurement(m).judged.verdict == Verdict::none);
    }
}

TEST_CASE("impacts can weaken although a quarter of the time passes without one") {
    std::vector<IdentifiedImpact> impacts(30);
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        impacts[k].tau = 3 * static_cast<double>(k);
        impacts[k].x_dot_after = 0.03 - 0.0005 * static_cast<double>(k);
    }
    impacts.back().tau = 400;
    impacts.back().x_dot_after = 0.001;
    CHECK(weakens(impacts));
    impacts.back().x_dot_after = 0.05;
    CHECK_FALSE(weakens(impacts));
}

TEST_CASE("a gap of the record splits the product if an impact can hide in it") {
    const TrueMotion motion = settled_motion(0.009, 0.85, 0.85, 20);
    std::vector<IdentifiedImpact> impacts = listed(motion.impacts);
    complete_impacts(motion.parameters, impacts, 0);
    const double from = impacts[100].tau, flight = impacts[101].tau - from;
    CHECK(
        continuity_of(motion.parameters, impacts, {{from + 0.5 * flight, from + 0.52 * flight}})
            .stretches.size() == 1);
    const Continuity broken =
        continuity_of(motion.parameters, impacts, {{from + 0.3 * flight, from + 0.6 * flight}});
    REQUIRE(broken.stretches.size() == 2);
    CHECK(broken.stretches[0].last == 100);
    CHECK(broken.stretches[1].first == 101);
    CHECK(broken.missing == 1);
}

TEST_CASE(
    "the momentum error is relative to the typical jump, and an impact that violates the balance "
    "is excluded") {
    const TrueMotion motion = settled_motion(0.009, 0.85, 0.85, 10);
    std::vector<IdentifiedImpact> impacts = listed(motion.impacts);
    std::vector<double> jumps;
    for (const IdentifiedImpact& i : impacts)
        jumps.push_back(std::abs(i.x_dot_after - i.x_dot_before));
    std::sort(jumps.begin(), jumps.end());
    const double typical = 0.5 * (jumps[(jumps.size() - 1) / 2] + jumps[jumps.size() / 2]);
    impacts[20].x_dot_after += 0.2 * typical;
    impacts[30].y_dot_after = std::nan("");
    complete_impacts(motion.parameters, impacts, 0);
    CHECK(impacts[10].momentum_error == doctest::Approx(0).epsilon(1e-9));
    CHECK(impacts[20].momentum_error == doctest::Approx(0.2).epsilon(1e-3));
    CHECK(impacts[20].fault == ImpactFault::momentum_lost);
    CHECK(std::isnan(impacts[30].momentum_error));
    CHECK(std::isnan(impacts[30].R));
}

TEST_CASE("R of the speed belongs to the measured speed, whatever the fitted stiffness") {
    Parameters p;
    p.table_plus = p.table_minus =
        std::make_shared<const RestitutionTable>(RestitutionTable{{0, 0.05, 0.1}, {0.9, 0.6, 0.5}});
    UnknownValues values = given_unknowns(p, p.epsilon * p.G);
    values[Unknown::stiffness] = 1.04;
    const IdentifiedSystem system(p, values, 0, nullptr);
    ImpactRecord impacts;
    system.run(0, default_state(p), {.tau_end = 100}, {&impacts});
    REQUIRE(impacts.entries.size() > 10);
    for (const Impact& own : impacts.entries) {
        const Impact i = system.measured(own, 0);
        CHECK(
            i.R == doctest::Approx(p.restitution(i.side, std::abs(i.relative_speed_before)))
                       .epsilon(1e-14));
    }
}
