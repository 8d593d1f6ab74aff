#include <doctest/doctest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>

#include "core/regime.hpp"
#include "support.hpp"

using namespace vines;
using namespace vines::test;

namespace {

Regime judge(const Parameters& p, const State& start, double tau_end = 1709, double tau_start = 0) {
    ContactRecord contacts;
    StroboscopicRecord stroboscopic(p);
    Observer* const observers[] = {&contacts, &stroboscopic};
    const Outcome outcome = simulate(p, start, {tau_end, 10000000, {}}, observers);
    return regime_of(p, start, {contacts, stroboscopic, tau_start, outcome.tau});
}
Regime judge(double b, Damping damping, double tau_end = 1709) { return judge(table1(b, damping), default_state(table1(b, damping)), tau_end); }

State after(const Parameters& p, const State& start, double tau, double duration) { return simulate(p, start, {tau + duration, 1000000, {}, tau}, {}).state; }

/// Moduli of the eigenvalues of the return map, from differences of the motion itself.
std::array<double, 4> multipliers_by_differences(const Parameters& p, const PeriodicOrbit& orbit) {
    const double period = orbit.cycles * 2 * std::numbers::pi / p.Omega, step = 1e-6 * p.b;
    double State::*const parts[] = {&State::x_dot, &State::x, &State::y_dot, &State::y};
    Matrix4 D;
    for (int j = 0; j < 4; ++j) {
        State up = orbit.state, down = orbit.state;
        up.*parts[j] += step;
        down.*parts[j] -= step;
        up = after(p, up, orbit.tau, period);
        down = after(p, down, orbit.tau, period);
        for (int i = 0; i < 4; ++i) D(i, j) = (up.*parts[i] - down.*parts[i]) / (2 * step);
    }
    return eigenvalue_moduli(D);
}

/// The captured response of b = 22 mm: a chatter and a stick in each half period of 3 pi. Which of the starts is captured
/// when is chance; that one of them is, is not.
Regime captured() {
    for (int k = 0;; ++k) {
        Parameters p = table1(0.022 + k * 1e-9, Damping::closed_form);
        const Regime r = judge(p, default_state(p), 1e5);
        if (r.orbit) return r;
        REQUIRE(k < 20);
    }
}

}  // namespace

TEST_CASE("the paper's regimes are found at its b with the closed-form damping") {
    const std::pair<double, RegimeType> known[] = {{0.040, RegimeType::I}, {0.034, RegimeType::I}, {0.031, RegimeType::II}, {0.028, RegimeType::II}, {0.025, RegimeType::II},
                                                   {0.022, RegimeType::II}, {0.020, RegimeType::II}, {0.018, RegimeType::II}, {0.017, RegimeType::II}, {0.0165, RegimeType::II},
                                                   {0.015, RegimeType::III}, {0.008, RegimeType::III}, {0.0065, RegimeType::IV}, {0.0046, RegimeType::V}, {0.003, RegimeType::VI}};
    for (const auto& k : known) {
        CAPTURE(k.first);
        CHECK(std::string(name_of(judge(k.first, Damping::closed_form).type)) == name_of(k.second));
    }
}

TEST_CASE("impacts per cycle are those of the long run") {
    // Means of a program that counts some impacts of each chatter (here it counts as one: up to a tenth less); one run of
    // 20000 scatters by some per cent.
    const std::tuple<double, Damping, double> known[] = {{0.034, Damping::closed_form, 0.77}, {0.025, Damping::closed_form, 1.23}, {0.018, Damping::closed_form, 1.70},
                                                         {0.022, Damping::equation_of_motion, 1.79}};
    for (const auto& k : known) {
        CAPTURE(std::get<0>(k));
        CHECK(judge(std::get<0>(k), std::get<1>(k), 20000).z_overall == doctest::Approx(std::get<2>(k)).epsilon(0.18));
    }
}

TEST_CASE("impacts per cycle of a periodic response are whole numbers, whatever its transient") {
    CHECK(judge(0.015, Damping::closed_form).z == 2);
    CHECK(judge(0.008, Damping::equation_of_motion).z == 3);
    CHECK(judge(0.004, Damping::equation_of_motion).z == 4);
}

TEST_CASE("a periodic orbit returns to itself, and its multipliers are those of the motion's differences") {
    const std::pair<double, Damping> cases[] = {{0.015, Damping::closed_form}, {0.0065, Damping::closed_form}, {0.0046, Damping::closed_form}, {0.008, Damping::equation_of_motion},
                                                {0.006, Damping::equation_of_motion}, {0.004, Damping::equation_of_motion}};
    for (const auto& k : cases) {
        CAPTURE(k.first);
        const Parameters p = table1(k.first, k.second);
        const Regime r = judge(k.first, k.second);
        REQUIRE(r.orbit);
        const PeriodicOrbit& o = *r.orbit;
        CHECK(o.closure < 1e-12);
        CHECK(o.stable());
        const auto differences = multipliers_by_differences(p, o);
        for (int i = 0; i < 4; ++i) CHECK(std::abs(o.multipliers[i]) == doctest::Approx(differences[i]).epsilon(1e-4));
        double log_det = 0;
        for (const auto& m : o.multipliers) log_det += std::log(std::abs(m));
        const double period = o.cycles * 2 * std::numbers::pi;
        CHECK(log_det == doctest::Approx(-2 * p.zeta() * period + 2 * static_cast<double>(o.impacts) * std::log(0.6)).epsilon(1e-9));
    }
}

TEST_CASE("the multipliers of a regular response are the exponents of a long window") {
    const Parameters p = table1(0.015, Damping::closed_form);
    Lyapunov lyapunov(p, 5000, 30000, {true, false, false, 256});
    record(p, default_state(p), 30000, 1000000, {&lyapunov});
    const Exponents of_orbit = judge(0.015, Damping::closed_form).orbit->exponents(p);
    // The two pairs are complex: QR's split of each pair dies out as 1/T, its sum is exact.
    const Exponents qr = lyapunov.product().qr();
    CHECK(qr[0] + qr[1] == doctest::Approx(of_orbit[0] + of_orbit[1]).epsilon(1e-3));
    CHECK(qr[2] + qr[3] == doctest::Approx(of_orbit[2] + of_orbit[3]).epsilon(1e-3));
}

TEST_CASE("symmetry is told from the orbit, and the period is the smallest") {
    CHECK(judge(0.015, Damping::closed_form).orbit->symmetric);
    CHECK_FALSE(judge(0.0065, Damping::closed_form).orbit->symmetric);
    CHECK(judge(0.015, Damping::closed_form).orbit->cycles == 1);
    CHECK(judge(0.0046, Damping::closed_form).orbit->cycles == 2);
    CHECK(judge(0.006, Damping::equation_of_motion).orbit->cycles == 3);
}

TEST_CASE("a run that has not come close yet is periodic if following it further shows that it is attracted") {
    const Parameters p = table1(0.015, Damping::closed_form);
    const Regime r = judge(p, default_state(p), 500);
    REQUIRE(r.orbit);
    CHECK(r.type == RegimeType::III);
    CHECK(r.capture->tau < 500);
}

TEST_CASE("a chaotic run is not periodic however long it is") {
    for (double tau_end : {500., 2000., 5000., 20000.}) {
        CAPTURE(tau_end);
        CHECK_FALSE(judge(0.028, Damping::closed_form, tau_end).orbit);
        CHECK_FALSE(judge(0.003, Damping::closed_form, tau_end).orbit);
    }
}

TEST_CASE("a chaotic transient that a sticking orbit captures is reported with its moment and the exponents of both") {
    const Regime r = captured();
    CHECK(r.orbit->cycles == 3);
    CHECK(r.orbit->contacts == 2);  // each a whole chatter
    CHECK(r.orbit->sticks == 2);
    CHECK(r.orbit->impacts > 40);
    CHECK(r.orbit->symmetric);
    CHECK(r.type == RegimeType::V);
    CHECK(std::abs(r.orbit->multipliers[2]) == 0);
    REQUIRE(r.capture);
    CHECK(r.capture->chaotic_before);
    CHECK(r.capture->before[0] == doctest::Approx(0.10).epsilon(0.2));
    CHECK(r.capture->after[0] == doctest::Approx(-0.00703).epsilon(0.01));
    const auto differences = multipliers_by_differences(table1(0.022, Damping::closed_form), *r.orbit);
    CHECK(std::abs(r.orbit->multipliers[0]) == doctest::Approx(differences[0]).epsilon(1e-3));
    CHECK(std::abs(r.orbit->multipliers[1]) == doctest::Approx(differences[1]).epsilon(1e-3));
}

TEST_CASE("a response without impacts is a fixed point, of no type") {
    const Regime r = judge(0.5, Damping::equation_of_motion);
    CHECK(r.type == RegimeType::none);
    CHECK(r.z == 0);
    REQUIRE(r.orbit);
    CHECK(r.orbit->contacts == 0);
    CHECK(std::abs(r.orbit->multipliers[0]) == doctest::Approx(1));  // of the mass that nothing moves
}

TEST_CASE("few impacts, one impact and a free decay are judged without fuss") {
    Parameters p = table1(0.04, Damping::closed_form);
    CHECK(judge(p, default_state(p), 60).contacts <= 2);
    CHECK(judge(p, default_state(p), 1e-3).type == RegimeType::none);
    p.G = 0;
    const Regime decay = judge(p, {0, 0.05, 0, 0.02}, 500);
    CHECK(decay.contacts > 0);
    CHECK(decay.type == RegimeType::none);
}

TEST_CASE("a chatter that ends in a stick is one contact, of the side and the moment of its first impact") {
    const Parameters p = table1(0.015, Damping::closed_form);
    ContactRecord contacts;
    const Record run = record(p, default_state(p), 100, 1000000, {&contacts});
    REQUIRE(run.sticks.size() == 1);
    CHECK(contacts.impacts == static_cast<long>(run.impacts.size()));
    CHECK(contacts.contacts.size() == run.impacts.size() - static_cast<std::size_t>(run.sticks[0].start.impacts) + 1);
}

TEST_CASE("shares of cycles add up to one, and stretches follow each other without a gap") {
    const Regime r = judge(0.022, Damping::closed_form);
    double sum = 0;
    for (double share : r.cycles_with) sum += share;
    CHECK(sum == doctest::Approx(1));
    REQUIRE(r.stretches.size() > 4);
    for (std::size_t i = 1; i < r.stretches.size(); ++i) CHECK(r.stretches[i].tau_start == r.stretches[i - 1].tau_end);
    CHECK(r.synchronised > 0.3);
    CHECK(r.synchronised < 0.9);
    CHECK(judge(0.040, Damping::closed_form).synchronised == 0);
}

TEST_CASE("the verdict on a window needs three standard errors") {
    CHECK(verdict_of(0.1, 0.03) == Verdict::chaotic);
    CHECK(verdict_of(0.1, 0.04) == Verdict::not_decided);
    CHECK(verdict_of(-0.01, 0.001) == Verdict::regular);
    CHECK(verdict_of(-0.01, std::nan("")) == Verdict::not_decided);
}
