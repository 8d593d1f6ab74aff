#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "../support.hpp"

using namespace vines;
using namespace vines::test;

namespace {

Parameters with_zeta(double zeta, double Omega) {
    Parameters p;
    p.damping = Damping::closed_form;
    p.epsilon = 0.01;
    p.lambda = zeta / p.epsilon;
    p.Omega = Omega;
    return p;
}

/// The paper's closed form, eqs. (8)-(10), of x and x' (the forcing phase is theta at s = 0).
struct ClosedForm {
    double x, x_dot;
};
ClosedForm closed_form(const Parameters& p, const Oscillation& o, double s) {
    const double z = p.zeta(), W = p.Omega, wd = std::sqrt(1 - z * z), a = p.epsilon * p.A(),
                 theta = std::atan2(o.sin_theta, o.cos_theta);
    const double D = (1 - W * W) * (1 - W * W) + 4 * z * z * W * W, X = a * (1 - W * W) / D,
                 Y = -2 * z * W * a / D;
    const double q = o.x - (X * std::sin(theta) + Y * std::cos(theta));
    const double r = (o.x_dot - W * (X * std::cos(theta) - Y * std::sin(theta)) + z * q) / wd;
    const double e = std::exp(-z * s), c = std::cos(wd * s), n = std::sin(wd * s),
                 t = theta + W * s;
    return {
        e * (q * c + r * n) + X * std::sin(t) + Y * std::cos(t),
        e * ((wd * r - z * q) * c - (wd * q + z * r) * n) +
            W * (X * std::cos(t) - Y * std::sin(t))};
}

const Oscillation start{0.003, -0.004, std::sin(0.7), std::cos(0.7)};

}  // namespace

TEST_CASE("the flow is the paper's closed form") {
    for (double zeta : {0.006, 0.012, 0.3, 0.9})
        for (double Omega : {0.4, 1.0, 2.3}) {
            CAPTURE(zeta);
            CAPTURE(Omega);
            const Parameters p = with_zeta(zeta, Omega);
            const Flow flow = *Flow::shared_free(p);
            for (double s : {0.0, 1e-9, 0.01, 0.15, 0.16, 1.0, 7.3, 20.0, 300.0}) {
                const Oscillation o = flow.after(start, s);
                const ClosedForm c = closed_form(p, start, s);
                CHECK(std::abs(o.x - c.x) < 1e-15);
                CHECK(std::abs(o.x_dot - c.x_dot) < 1e-15);
                CHECK(std::abs(o.sin_theta - std::sin(0.7 + Omega * s)) < 1e-15 * (1 + Omega * s));
            }
        }
}

TEST_CASE("the transfer matrix is eq. (19), and the derivative of the flow by its start") {
    for (double zeta : {0.012, 0.5}) {
        const Parameters p = with_zeta(zeta, 1.7);
        const Flow flow = *Flow::shared_free(p);
        const double wd = std::sqrt(1 - zeta * zeta);
        for (double s : {1e-6, 0.1, 2.0, 33.0}) {
            const Transfer t = flow.transfer(s);
            const double e = std::exp(-zeta * s), c = std::cos(wd * s), n = std::sin(wd * s);
            CHECK(std::abs(t.a11 - e * (c - zeta / wd * n)) < 1e-14);
            CHECK(std::abs(t.a12 - -e / wd * n) < 1e-14);
            CHECK(std::abs(t.a21 - e / wd * n) < 1e-14);
            CHECK(std::abs(t.a22 - e * (zeta / wd * n + c)) < 1e-14);
            // The flow is linear: a difference quotient of any size is exact.
            Oscillation moved = start;
            moved.x_dot += 1;
            CHECK(std::abs(flow.after(moved, s).x - flow.after(start, s).x - t.a21) < 1e-14);
            CHECK(
                std::abs(flow.after(moved, s).x_dot - flow.after(start, s).x_dot - t.a11) < 1e-14);
        }
    }
}

TEST_CASE("without damping at resonance the response grows with time") {
    const Parameters p = with_zeta(0, 1);
    const double a = p.epsilon * p.A();
    const Flow flow = *Flow::shared_free(p);
    for (double s : {0.1, 3.0, 50.0}) {  // x'' + x = a sin s from rest: x = a (sin s - s cos s)/2
        const Oscillation o = flow.after({0, 0, 0, 1}, s);
        CHECK(std::abs(o.x - a * (std::sin(s) - s * std::cos(s)) / 2) < 1e-16);
    }
}

TEST_CASE("near an undamped resonance no digits are lost to cancellation") {
    const Flow at = *Flow::shared_free(with_zeta(0, 1)),
               beside = *Flow::shared_free(with_zeta(0, 1 + 1e-12));
    CHECK(std::abs(at.after(start, 100).x - beside.after(start, 100).x) < 1e-12);
}

TEST_CASE("critical and over-critical damping are their closed forms") {
    Parameters p = with_zeta(1, 1);
    p.G = 0;
    for (double s : {0.05, 1.0, 5.0})  // x = e^-s (x0 + (v0 + x0) s)
        CHECK(
            std::abs(
                Flow::shared_free(p)->after(start, s).x -
                std::exp(-s) * (start.x + (start.x_dot + start.x) * s)) < 1e-17);
    p = with_zeta(3, 1);
    p.G = 0;
    const double m1 = -3 + std::sqrt(8.0), m2 = -3 - std::sqrt(8.0),
                 c1 = (start.x_dot - m2 * start.x) / (m1 - m2), c2 = start.x - c1;
    for (double s : {0.01, 0.5, 4.0})
        CHECK(
            std::abs(
                Flow::shared_free(p)->after(start, s).x -
                (c1 * std::exp(m1 * s) + c2 * std::exp(m2 * s))) < 1e-17);
}

TEST_CASE("the bounds of the motion hold over the whole reach") {
    std::mt19937_64 engine(7);
    for (int n = 0; n < 200; ++n) {
        const System system = random_system(engine);
        const Flow flow = engine() % 2 ? *Flow::shared_free(system.parameters)
                                       : *Flow::shared_sticking(system.parameters);
        Oscillation o{system.start.x, system.start.x_dot, std::sin(n), std::cos(n)};
        const auto bounds = flow.bounds(o);
        double x = 0, a = 0, j = 0;
        for (int k = 0; k <= 1000; ++k) {
            const Oscillation at = flow.after(o, flow.reach() * k / 1000);
            x = std::max(x, std::abs(at.x));
            a = std::max(a, std::abs(flow.acceleration(at)));
            j = std::max(j, std::abs(flow.jerk(at)));
        }
        CHECK(x <= bounds.x);
        CHECK(a <= bounds.x_ddot);
        CHECK(j <= bounds.x_dddot);
    }
}
