// Loads: records and formulas. Their motion against the equations of motion, closed forms and
// reference trajectories.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

#include "../reference/laws.hpp"
#include "../support.hpp"
#include "core/measures/energy.hpp"
#include "core/motion/load.hpp"
#include "core/motion/record.hpp"
#include "whole_run.hpp"

using namespace vines;
using namespace vines::test;

namespace {

Parameters loaded(LoadKind kind, double scale) {
    std::mt19937_64 engine(5);
    std::vector<double> tau, values;
    for (int i = 0; i <= 400; ++i) {
        tau.push_back(0.1 * i + (i > 0 && i < 400 ? uniform(engine, -0.02, 0.02) : 0));
        values.push_back(scale * (std::sin(0.97 * tau.back()) + 0.2 * uniform(engine, -1, 1)));
    }
    Parameters p;
    p.epsilon = 0.05, p.lambda = 0.4, p.G = 0, p.b = 0.02, p.R_plus = 0.7, p.R_minus = 0.6;
    p.load = std::make_shared<const Load>(kind, tau, values);
    return p;
}

}  // namespace

TEST_CASE("the base of a recorded acceleration is its double integral") {
    const std::vector<double> tau = {0, 1, 3}, a = {1, 2, -2};
    const Load load(LoadKind::base_acceleration, tau, a);
    // a = 1 + s on [0, 1], 2 - 2 (s - 1) on [1, 3]; afterwards a constant velocity.
    CHECK(load.base(0, 0).at(1) == doctest::Approx(0.5 + 1. / 6));
    CHECK(load.base(0, 0).rate(1) == doctest::Approx(1.5));
    CHECK(load.base(1, 1).at(2) == doctest::Approx(2. / 3 + 3 + 4 - 8. / 3));
    CHECK(load.base(2, 5).at(0) == doctest::Approx(load.base(1, 1).at(2) + 2 * 1.5));
    CHECK(load.base(1, 2).at(0.5) == doctest::Approx(load.base(1, 1).at(1.5)));
    CHECK(
        load.force(0, 0, 0.3).at(0.5) ==
        doctest::Approx(load.base(0, 0).at(0.5) + 0.3 * load.base(0, 0).rate(0.5)));
}

TEST_CASE("a motion under a recorded load satisfies the equation of motion between its events") {
    for (const LoadKind kind :
         {LoadKind::base_acceleration, LoadKind::base_displacement, LoadKind::force}) {
        const Parameters p = loaded(kind, 0.03);
        struct Residual : Observer {
            explicit Residual(const Parameters& of) : p(of) {}
            void on_stretch(const Stretch& s) override {
                ++stretches;
                const double at = 0.5 * s.duration, tau = s.tau + at;
                const auto k = p.load->interval_at(tau);
                const double force = p.load->force(k, tau, p.epsilon * p.lambda).at(0);
                const State x = s.at(at);
                const double mass = s.is_joint() ? 1 + p.epsilon : 1;
                largest = std::max(
                    largest, std::abs(mass * s.x_ddot(at) + 2 * p.zeta() * x.x_dot + x.x - force));
                if (last_tau == s.tau && !hit)
                    jump = std::max(
                        jump, (vector_of(s.at(0)) - vector_of(last)).cwiseAbs().maxCoeff());
                last = s.at(s.duration), last_tau = s.tau + s.duration;
                hit = false;
            }
            void on_impact(const Impact&) override { hit = true, ++impacts; }
            void on_stick(const StickStart&) override { hit = true; }
            const Parameters& p;
            double largest = 0, jump = 0, last_tau = -1;
            State last;
            bool hit = false;
            int stretches = 0, impacts = 0;
        } residual(p);
        Observer* const observers[] = {&residual};
        const Outcome end = simulate(p, {0, 0, 0.01, 0}, {45, 10000, {}}, observers);
        CHECK(end.tau == 45);
        CHECK(residual.stretches > 400);
        CHECK(residual.impacts > 20);
        CHECK(residual.largest < 1e-13);
        CHECK(residual.jump < 1e-14);
    }
}

TEST_CASE("a long interval of a load is that of many short ones, with and without contacts") {
    const auto record = [](int parts) {
        std::vector<double> tau, values;
        for (int k = 0; k <= parts; ++k)
            tau.push_back(60.0 * k / parts), values.push_back(0.001 * k / parts);
        return std::make_shared<const Load>(LoadKind::base_acceleration, tau, values);
    };
    for (const double b : {100.0, 0.02})
        for (const double friction : {0.0, 1e-4}) {
            Parameters p;
            p.epsilon = 0.05, p.lambda = 0.4, p.G = 0, p.Omega = 1, p.b = b, p.friction = friction;
            p.load = record(1);
            const State one = simulate(p, {0.01, 0, 0, 0}, {.tau_end = 90}).state;
            p.load = record(600);
            const State many = simulate(p, {0.01, 0, 0, 0}, {.tau_end = 90}).state;
            CHECK(std::abs(one.x - many.x) < 1e-9);
            CHECK(std::abs(one.y - many.y) < 1e-9);
        }
}

TEST_CASE("a recorded sine is the harmonic forcing within its interpolation error") {
    Parameters p;
    p.epsilon = 0.05, p.lambda = 0.4, p.G = 0.4, p.b = 0.04;
    const double F = p.epsilon * p.G;
    std::vector<double> tau, x;
    for (int i = 0; i <= 2000; ++i) {
        tau.push_back(2 * 3.141592653589793 * i / 200);
        x.push_back(F * std::sin(tau.back()));
    }
    ImpactRecord harmonic, recorded;
    Observer* const first[] = {&harmonic};
    Observer* const second[] = {&recorded};
    simulate(p, {0, 0, 0, 0.01}, {30, 1000, {}}, first);
    Parameters q = p;
    q.G = 0;
    q.load = std::make_shared<const Load>(LoadKind::base_displacement, tau, x);
    simulate(q, {0, 0, 0, 0.01}, {30, 1000, {}}, second);
    REQUIRE(harmonic.entries.size() > 5);
    REQUIRE(harmonic.entries.size() == recorded.entries.size());
    // A chord of a sine over 1/200 of a period differs from it by 1.2e-4 of its amplitude.
    for (std::size_t i = 0; i < harmonic.entries.size(); ++i)
        CHECK(std::abs(harmonic.entries[i].tau - recorded.entries[i].tau) < 0.01);
}

TEST_CASE("the energy and the deviations of a loaded motion balance") {
    for (const LoadKind kind : {LoadKind::base_acceleration, LoadKind::force}) {
        Parameters p = loaded(kind, 0.03);
        p.gravity = 0.002, p.friction = 0.001;
        Energy energy(p, {0, 45});
        Observer* const observers[] = {&energy};
        simulate(p, {0, 0, 0.01, 0}, {45, 100000, {}}, observers);
        const EnergyBalance balance = energy.balance({0, 45});
        CHECK(std::abs(balance.residual) < 1e-12 * std::max(balance.input, balance.damper));
        CHECK(balance.friction > 0);
        WholeRunProduct product(p);
        Observer* const with[] = {&product};
        const State start{0, 0, 0.01, 0.001};
        constexpr double until = 9;
        simulate(p, start, {until, 1000, {}}, with);
        const Matrix4 derivative = derivative_of_run(p, start, until);
        for (int k = 0; k < 4; ++k)
            CHECK((derivative.col(k) - product.m.col(k)).norm() < 1e-6 * (1 + product.m.norm()));
    }
}

namespace {

/// Largest difference between the base of a load and a formula, over the load.
double misfit(const Load& load, double until, const std::function<double(double)>& base) {
    double largest = 0;
    for (int i = 0; i < 5000; ++i) {
        const double tau = until * i / 5000;
        const std::size_t k = load.interval_at(tau);
        // At the time itself, and by the polynomial from an earlier one.
        const double from = std::max(tau - 0.05, k > 0 ? load.end_of(k - 1) : 0);
        largest = std::max(
            {largest, std::abs(load.base(k, tau)[0] - base(tau)),
             std::abs(load.base(k, from).at(tau - from) - base(tau))});
    }
    return largest;
}

}  // namespace

TEST_CASE("formulas move the base as they say, to rounding") {
    constexpr double a = 0.02, W = 1.7, T = 40;
    const Load half_sine(LoadKind::base_acceleration, a, T, [](double tau) {
        return Polynomial{std::numbers::pi / T * tau, std::numbers::pi / T};
    });
    const double w = std::numbers::pi / T;
    CHECK(misfit(half_sine, T, [&](double t) {
              return a / w * (t - std::sin(w * t) / w);
          }) < 1e-14 * a * T * T);
    CHECK(half_sine.base(half_sine.interval_at(T + 1), T + 1)[1] == doctest::Approx(2 * a / w));
    const Load chirp(LoadKind::base_displacement, a, T, [](double tau) {
        return Polynomial{0.3 + tau * (0.5 + 0.02 * tau), 0.5 + 0.04 * tau, 0.02};
    });
    CHECK(misfit(chirp, T, [&](double t) {
              return a * std::sin(0.3 + t * (0.5 + 0.02 * t));
          }) < 2e-14 * a);
    const Load harmonics({{a, W, 0.4}, {0.5 * a, 3 * W, -1}, {0.1 * a, 0, 1}});
    CHECK(harmonics.length() == infinity);
    CHECK(misfit(harmonics, 900, [&](double t) {
              return a * std::sin(W * t + 0.4) + 0.5 * a * std::sin(3 * W * t - 1) +
                     0.1 * a * std::sin(1);
          }) < 2e-12 * a);  // the rounding of t in this formula
}

TEST_CASE("a load far faster than the oscillator is a blow: m1 and the ball move as after it") {
    for (const double duration : {0.02, 5e-3, 1e-4}) {
        CAPTURE(duration);
        const double Omega = std::numbers::pi / duration, blow = 0.01;
        Parameters p, free;
        p.epsilon = free.epsilon = 0.02, p.lambda = free.lambda = 1;
        p.G = free.G = 0, p.b = free.b = 0.004;
        p.load = std::make_shared<const Load>(
            LoadKind::force, 0.5 * blow * Omega, duration,
            [Omega](double tau) { return Polynomial{Omega * tau, Omega}; });
        const Record struck = record(p, {}, 20), moved = record(free, {.x_dot = blow}, 20);
        REQUIRE(struck.impacts.size() > 3);
        REQUIRE(moved.impacts.size() > 3);
        for (int k = 0; k < 3; ++k)
            CHECK(
                std::abs(struck.impacts[k].tau - moved.impacts[k].tau - 0.5 * duration) <
                2 * duration * duration);
    }
}

TEST_CASE("noise has its rms, its band and its bound, and leaves the base at rest") {
    constexpr double rms = 0.03, T = 300;
    const Load noise = Load::noise(rms, 0.5, 3, T, 7), same = Load::noise(rms, 0.5, 3, T, 7);
    double square = 0, jump = 0;
    int pieces = 0;
    for (std::size_t k = 0; noise.end_of(k) < infinity; ++k) {
        const double from = k > 0 ? noise.end_of(k - 1) : 0, to = noise.end_of(k);
        const Polynomial base = noise.base(k, from), next = noise.base(k + 1, to);
        square += std::pow(base.second(0), 2);
        if (noise.end_of(k + 1) < infinity)
            jump = std::max(jump, std::abs(base.second(to - from) - next.second(0)));
        CHECK(base.at(to - from) == doctest::Approx(next[0]).epsilon(1e-9).scale(1e-3));
        ++pieces;
    }
    CHECK(std::sqrt(square / pieces) == doctest::Approx(rms).epsilon(1e-3));
    CHECK(noise.base(noise.interval_at(T), T).rate(0) == 0);
    CHECK(noise.base(noise.interval_at(T), T).at(0) == doctest::Approx(0).scale(1e-12));
    CHECK(noise.sampling_error() > 0);
    CHECK(noise.sampling_error() < 1e-6 * rms / (3 * 3));
    // The cubics miss the acceleration by h^2/12 of its second derivative.
    CHECK(jump < 0.02 * rms);
    CHECK(noise.base(5, 1.).at(0) == same.base(5, 1.).at(0));
    CHECK(Load::noise(rms, 0.5, 3, T, 8).base(5, 1.).at(0) != noise.base(5, 1.).at(0));
}

TEST_CASE("one of harmonics is the harmonic forcing") {
    Parameters p;
    p.epsilon = 0.05, p.lambda = 0.4, p.G = 0.4, p.Omega = 0.93, p.b = 0.04;
    p.gravity = 0.001, p.friction = 0.0005;
    ImpactRecord one, other;
    Observer* const first[] = {&one};
    Observer* const second[] = {&other};
    simulate(p, {0, 0, 0, 0.01}, {40, 1000, {}}, first);
    Parameters q = p;
    q.load = std::make_shared<const Load>(std::vector<LoadHarmonic>{{p.epsilon * p.G, p.Omega, 0}});
    q.G = 0;
    simulate(q, {0, 0, 0, 0.01}, {40, 1000, {}}, second);
    REQUIRE(one.entries.size() > 20);
    REQUIRE(one.entries.size() == other.entries.size());
    for (std::size_t i = 0; i < 15; ++i) {
        CHECK(std::abs(one.entries[i].tau - other.entries[i].tau) < 1e-11);
        CHECK(std::abs(one.entries[i].y_dot_after - other.entries[i].y_dot_after) < 1e-11);
    }
}

TEST_CASE("one of harmonics is the harmonic forcing under any damping") {
    for (const double damping_ratio : {0.0, 0.7, 1.2, 3.0, 10.0}) {
        Parameters p;
        p.epsilon = 0.01, p.lambda = 2 * damping_ratio / p.epsilon, p.Omega = 1, p.G = 1;
        p.b = 100;
        const State harmonic = simulate(p, {}, {.tau_end = 30}).state;
        p.load =
            std::make_shared<const Load>(std::vector<LoadHarmonic>{{p.epsilon * p.G, p.Omega, 0}});
        p.G = 0;
        const State loaded = simulate(p, {}, {.tau_end = 30}).state;
        CAPTURE(damping_ratio);
        CHECK(std::abs(loaded.x - harmonic.x) < 1e-14);
        CHECK(std::abs(loaded.x_dot - harmonic.x_dot) < 1e-14);
    }
}

TEST_CASE("a ball that a jump of the load releases leaves with the difference of accelerations") {
    const double k1 = 4 * std::numbers::pi * std::numbers::pi;
    const auto force = [&](double newton, double seconds) {
        const double end = 2 * std::numbers::pi * seconds;
        return std::make_shared<const Load>(
            LoadKind::force, std::vector{0.0, end}, std::vector{newton / k1, newton / k1});
    };
    Parameters p;  // values of an independent integrator
    p.epsilon = 0.13, p.lambda = 0.1 / 0.13, p.G = 0, p.Omega = 1, p.b = 0.005;
    p.R_plus = p.R_minus = 0;
    p.load = force(-0.4, 0.05);
    ImpactRecord impacts;
    const State released =
        simulate(p, {0, -0.007, 0, -0.002}, {.tau_end = 1.0799}, std::vector<Observer*>{&impacts})
            .state;
    CHECK(impacts.entries.empty());
    CHECK(released.y_dot == doctest::Approx(-0.00084634).epsilon(1e-4));
    CHECK(released.x - released.y == doctest::Approx(-0.0029744).epsilon(1e-3));

    p.epsilon = 0.1, p.lambda = 1, p.b = 0.1, p.R_plus = p.R_minus = 0.5, p.friction = 0.004;
    p.load = force(-0.3, 0.1);
    const State sliding = simulate(p, {-0.001, -0.007, -0.001, 0}, {.tau_end = 0.7854}).state;
    CHECK(sliding.y_dot == doctest::Approx(-4.616e-4).epsilon(1e-3));
}

TEST_CASE("gravity, friction, R of the speed and a load follow the reference in 60 digits") {
    for (const LawCase& law : law_cases()) {
        CAPTURE(law.name);
        Parameters p;
        p.epsilon = law.epsilon, p.lambda = law.lambda, p.G = law.G, p.Omega = law.Omega;
        p.b = law.b, p.R_plus = p.R_minus = law.R;
        p.gravity = law.gravity, p.friction = law.friction;
        if (!law.speed.empty())
            p.table_plus = p.table_minus =
                std::make_shared<const RestitutionTable>(RestitutionTable{law.speed, law.table});
        if (!law.load.empty())
            p.load =
                std::make_shared<const Load>(LoadKind::base_acceleration, law.load_tau, law.load);
        struct Compared : WholeRunProduct {
            using WholeRunProduct::WholeRunProduct;
            void on_impact(const Impact& i) override {
                WholeRunProduct::on_impact(i);
                impacts.push_back(i), growth.push_back(std::max(1.0, m.norm()));
            }
            std::vector<Impact> impacts;
            std::vector<double> growth;
        } run(p);
        Observer* const observers[] = {&run};
        simulate(p, {0, 0, law.y_dot0, law.y0}, {30, law_impacts, {}}, observers);
        const auto truth = read_reference("law_" + law.name).impacts;
        REQUIRE(truth.size() == law_impacts);
        REQUIRE(run.impacts.size() >= 30);
        double most_grown = 1;
        for (std::size_t k = 0; k < 30; ++k) {
            const Impact& own = run.impacts[k];
            const ReferenceImpact& other = truth[k];
            most_grown = std::max(most_grown, run.growth[k]);
            const double tolerance = 1e-11 * most_grown;
            CHECK(own.side == other.side);
            CHECK(std::abs(own.tau - other.tau) < tolerance);
            CHECK(std::abs(own.x - other.x) < tolerance);
            CHECK(std::abs(own.x_dot_after - other.x_dot_after) < tolerance);
            CHECK(std::abs(own.y_dot_after - other.y_dot_after) < tolerance);
        }
    }
}
