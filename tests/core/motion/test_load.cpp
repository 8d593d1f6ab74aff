// Recorded loads, against an integrator that knows nothing but the equations of motion.
#include <doctest/doctest.h>

#include <cmath>
#include <random>

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
        Energy energy(p, 0, 45);
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
