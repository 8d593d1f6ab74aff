#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "../support.hpp"

using namespace vines;
using namespace vines::test;

namespace {

double energy(const Parameters& p, const State& s) {
    return (s.x_dot * s.x_dot + s.x * s.x + p.epsilon * s.y_dot * s.y_dot) / 2;
}

/// Work of the forcing and of the damper over each stretch by Gauss quadrature: an independent
/// value of the energy at its end.
struct PowerBalance : Observer {
    explicit PowerBalance(const Parameters& parameters) : p(parameters) {}
    void on_stretch(const Stretch& stretch) override {
        static constexpr double node[4] = {
            0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
        static constexpr double weight[4] = {
            0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
        const int parts =
            std::max(1, static_cast<int>(stretch.duration / stretch.flow.cell() / 4) + 1);
        const double half = stretch.duration / parts / 2;
        for (int k = 0; k < parts; ++k)
            for (int j = 0; j < 8; ++j) {
                const double s = (2 * k + 1 + (j < 4 ? -node[j] : node[j - 4])) * half;
                const Oscillation o = stretch.flow.after(stretch.start, s);
                work += weight[j % 4] * half *
                        (p.epsilon * p.A() * o.sin_theta - 2 * p.zeta() * o.x_dot) * o.x_dot;
                scale += weight[j % 4] * half * std::abs(p.epsilon * p.A() * o.sin_theta * o.x_dot);
            }
    }
    void on_impact(const Impact& i) override {
        lost += (1 - i.R * i.R) * i.relative_speed_before * i.relative_speed_before * p.epsilon /
                (2 * (1 + p.epsilon));
    }
    const Parameters& p;
    double work = 0, lost = 0, scale = 0;
};

/// Continuity of the motion, order of time, and |x - y| <= b at 16 points of every stretch.
struct Invariants : Observer {
    explicit Invariants(const Parameters& parameters) : p(parameters) {}
    void on_stretch(const Stretch& s) override {
        ordered = ordered && std::abs(s.tau - tau) <= 1e-12 * (1 + tau) && s.duration >= 0;
        tau = s.tau + s.duration;
        for (int k = 0; k <= 16; ++k) {
            const State at = s.at(s.duration * k / 16);
            outside = std::max(outside, std::abs(at.x - at.y) - p.b);
            if (s.sticking_side != 0)
                apart = std::max(apart, std::abs(at.x - at.y - s.sticking_side * p.b));
        }
    }
    void on_impact(const Impact& i) override {
        ordered = ordered && i.tau >= last_impact;
        last_impact = i.tau;
        momentum = std::max(
            momentum, std::abs(
                          i.x_dot_after + p.epsilon * i.y_dot_after - i.x_dot_before -
                          p.epsilon * i.y_dot_before));
        restitution = std::max(
            restitution, std::abs(
                             i.x_dot_after - i.y_dot_after +
                             p.restitution(i.side, 0) * (i.x_dot_before - i.y_dot_before)));
        towards = towards && i.side * i.relative_speed_before > 0;
    }
    const Parameters& p;
    double tau = 0, last_impact = 0, outside = 0, apart = 0, momentum = 0, restitution = 0;
    bool ordered = true, towards = true;
};

}  // namespace

TEST_CASE(
    "thousands of random systems satisfy every invariant of the motion" *
    doctest::test_suite("long")) {
    std::mt19937_64 engine(2018);
    long impacts = 0, sticks = 0;
    for (int n = 0; n < 3000; ++n) {
        CAPTURE(n);
        const System s = random_system(engine);
        REQUIRE(validate(s.parameters, s.start).empty());
        PowerBalance power(s.parameters);
        Invariants invariants(s.parameters);
        const Record run = record(s.parameters, s.start, 150, 2000, {&power, &invariants});
        impacts += run.outcome.impacts;
        sticks += static_cast<long>(run.sticks.size());
        // Typical length and speed.
        const double speed = 0.05 + s.parameters.b + run.outcome.impacts * 1e-6;
        CHECK(invariants.ordered);
        CHECK(invariants.towards);
        CHECK(invariants.outside < 1e-13 * speed * 100);
        CHECK(invariants.apart < 1e-13 * speed * 100);
        CHECK(invariants.momentum < 1e-15);
        CHECK(invariants.restitution < 1e-15);
        const double change =
            energy(s.parameters, run.outcome.state) - energy(s.parameters, s.start);
        CHECK(
            std::abs(change - power.work + power.lost) <
            1e-11 * (power.scale + energy(s.parameters, s.start) + power.lost) + 1e-19);
    }
    CHECK(impacts > 100000);
    CHECK(sticks > 1000);
}

TEST_CASE("the run agrees with plain numerical integration") {
    // Independent method: classical Runge-Kutta of eq. (2) with 400 steps per unit of tau, contacts
    // by bisection of its steps.
    std::mt19937_64 engine(5);
    for (int n = 0; n < 40; ++n) {
        CAPTURE(n);
        System s = random_system(engine);
        Parameters& p = s.parameters;
        p.R_plus = p.R_minus = uniform(engine, 0.5, 0.9);
        p.b = std::max(p.b, 0.005);
        const Record run = record(p, s.start, 60, 6);
        if (run.impacts.size() < 6 || !run.sticks.empty()) continue;
        double x = s.start.x, v = s.start.x_dot, y = s.start.y, u = s.start.y_dot, tau = 0;
        const double h = 1.0 / 400;
        auto acceleration = [&](double t, double q, double w) {
            return p.epsilon * p.A() * std::sin(p.Omega * t + p.phi()) - q - 2 * p.zeta() * w;
        };
        auto step = [&](double d, double& q, double& w) {
            const double k1 = acceleration(tau, q, w),
                         k2 = acceleration(tau + d / 2, q + d / 2 * w, w + d / 2 * k1),
                         k3 = acceleration(
                             tau + d / 2, q + d / 2 * w + d * d / 4 * k1, w + d / 2 * k2),
                         k4 = acceleration(tau + d, q + d * w + d * d / 2 * k2, w + d * k3);
            q += d * w + d * d / 6 * (k1 + k2 + k3);
            w += d / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
        };
        for (const Impact& i : run.impacts) {
            // a grazing or chatter contact magnifies the integrator's error.
            if (std::abs(i.relative_speed_before) < 1e-4) break;
            for (;;) {
                double q = x, w = v;
                step(h, q, w);
                if (std::abs(q - y - u * h) > p.b && tau + h > i.tau - 1e-6) break;
                x = q, v = w, y += u * h, tau += h;
                REQUIRE(tau < i.tau + 1e-6);
            }
            double low = 0, high = h;
            while (high - low > 1e-13) {
                const double d = (low + high) / 2;
                double q = x, w = v;
                step(d, q, w);
                (std::abs(q - y - u * d) > p.b ? high : low) = d;
            }
            step(low, x, v);
            y += u * low, tau += low;
            REQUIRE(std::abs(tau - i.tau) < 1e-6);
            CHECK(std::abs(v - i.x_dot_before) < 1e-7);
            // Restart from the exact state, so that the integrator's error does not add up.
            x = i.x, v = i.x_dot_after, u = i.y_dot_after, y = i.x - i.side * p.b, tau = i.tau;
            double q = x, w = v;
            step(1e-5, q, w);
            x = q, v = w, y += u * 1e-5, tau += 1e-5;  // off the wall
        }
    }
}

TEST_CASE("a run ends at tau_end, and a contact there belongs to it") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const Record all = record(p, default_state(p), 100);
    const double at = all.impacts[2].tau;
    CHECK(record(p, default_state(p), at).impacts.size() == 3);
    CHECK(record(p, default_state(p), std::nextafter(at, 0)).impacts.size() == 2);
    CHECK(all.outcome.reason == End::tau_end);
    CHECK(all.outcome.tau == 100);
}

TEST_CASE(
    "a start on a wall is an impact if moving into it, a flight if moving away, sticking if "
    "pressed") {
    Parameters p = table1(0.01, Damping::closed_form);
    Record run = record(p, {0.01, 0, 0, -0.01}, 1);  // x - y = b, moving in
    REQUIRE(!run.impacts.empty());
    CHECK(run.impacts[0].tau == 0);
    CHECK(run.impacts[0].side == 1);
    run = record(p, {-0.01, 0, 0, -0.01}, 0.5);
    CHECK(run.impacts.empty());
    CHECK(run.sticks.empty());
    // Zero relative speed: x'' > 0 presses at x - y = +b.
    run = record(p, {0, -0.005, 0, -0.015}, 1);
    REQUIRE(run.sticks.size() == 1);
    CHECK(run.sticks[0].start.tau == 0);
    CHECK(run.sticks[0].start.impacts == 0);
    run = record(p, {0, 0.005, 0, -0.005}, 0.5);  // x'' < 0 separates them
    CHECK(run.sticks.empty());
    CHECK(run.impacts.empty());
}

TEST_CASE("a run can end at any impact, whether the ball sticks there or flies on") {
    // Impact times are rounded: about half of them lie after tau_end, by less than an ulp.
    for (const double R : {0.0, 0.6}) {
        Parameters p = table1(0.022, Damping::closed_form);
        p.R_plus = p.R_minus = R;
        for (const Impact& i : record(p, default_state(p), 200).impacts) {
            const Record again = record(p, default_state(p), i.tau);
            CHECK(again.outcome.tau == i.tau);
            CHECK(again.outcome.reason == End::tau_end);
            REQUIRE(!again.impacts.empty());
            CHECK(again.impacts.back().tau == i.tau);
        }
    }
}

TEST_CASE("a run can continue from a state outside the range permitted in a request") {
    Parameters p = table1(0.022, Damping::equation_of_motion);
    p.lambda = 0;
    p.G = 1000;
    const double tau = 100 * p.cycle();
    const Outcome grown =
        simulate(p, default_state(p), {.tau_end = tau, .max_impacts = 10000000}, {});
    REQUIRE(grown.reason == End::tau_end);
    REQUIRE_FALSE(validate(p, grown.state).empty());
    const Limits limits{.tau_end = 1.1 * tau, .max_impacts = 10000000, .tau_start = tau};
    CHECK(simulate(p, grown.state, limits, {}).reason == End::tau_end);
}

TEST_CASE("a system at rest on its wall stays there, as one sticking phase without an impact") {
    Parameters p = table1(0.01, Damping::closed_form);
    p.G = 0;
    const Record run = record(p, {0, 0, 0, 0.01}, 1000);
    CHECK(run.impacts.empty());
    CHECK(run.touches.empty());
    CHECK(run.sticks.size() == 1);
    CHECK(run.outcome.state.y == doctest::Approx(0.01));
    CHECK(run.outcome.reason == End::tau_end);
}

TEST_CASE("R = 0 sticks at the first contact that presses") {
    Parameters p = table1(0.003, Damping::closed_form);
    p.R_plus = p.R_minus = 0;
    const Record run = record(p, default_state(p), 200);
    REQUIRE(!run.sticks.empty());
    for (const auto& s : run.sticks) CHECK(s.start.impacts == 1);
    for (const Impact& i : run.impacts) CHECK(std::abs(i.relative_speed_after) == 0);
}

TEST_CASE(
    "R = 1 loses no energy at impacts and never sticks, and the impact limit ends a chatter") {
    Parameters p = table1(0.01, Damping::closed_form);
    p.R_plus = p.R_minus = 1;
    PowerBalance power(p);
    const Record run = record(p, default_state(p), 1e6, 20000, {&power});
    CHECK(run.outcome.reason == End::max_impacts);
    CHECK(run.outcome.impacts == 20000);
    CHECK(run.sticks.empty());
    CHECK(power.lost == 0);
}

TEST_CASE("the impacts of a chatter follow the geometric law until sticking") {
    const Parameters p = table1(0.015, Damping::closed_form);
    const Record run = record(p, default_state(p), 100);
    REQUIRE(run.sticks.size() == 1);
    CHECK(run.sticks[0].start.impacts > 30);
    CHECK(run.sticks[0].start.impacts < 60);
    std::size_t last = 0;
    while (run.impacts[last].tau <= run.sticks[0].start.tau && last + 1 < run.impacts.size())
        ++last;
    --last;
    for (std::size_t k = last - 10; k < last; ++k) {
        CHECK(
            run.impacts[k + 1].relative_speed_before / run.impacts[k].relative_speed_before ==
            doctest::Approx(0.6).epsilon(1e-6));
        CHECK_FALSE(run.impacts[k].grazing);
    }
}

TEST_CASE("a grazing contact is reported and does not end the flight") {
    // The ball rests in the middle; the undamped, unforced oscillator has amplitude b but for
    // rounding.
    Parameters p = table1(0.01, Damping::closed_form);
    p.lambda = 0;
    p.G = 0;
    const Record run = record(p, {0, 0.01 - 3e-17, 0, 0}, 6.5 * std::numbers::pi);
    CHECK(run.impacts.empty());
    REQUIRE(run.touches.size() == 6);
    for (int k = 0; k < 6; ++k) {
        CHECK(run.touches[k].tau == doctest::Approx((k + 1) * std::numbers::pi));
        CHECK(run.touches[k].side == (k % 2 ? 1 : -1));
    }
}

TEST_CASE("a stop function ends a run with the result so far") {
    const Parameters p = table1(0.022, Damping::closed_form);
    long asked = 0;
    const Outcome outcome =
        simulate(p, default_state(p), {1e7, 1000000000, [&] { return ++asked > 10; }}, {});
    CHECK(outcome.reason == End::stopped);
    CHECK(outcome.tau < 1e5);
}
