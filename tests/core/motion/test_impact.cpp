#include <doctest/doctest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "../support.hpp"
#include "core/stability/exterior.hpp"

using namespace vines;
using namespace vines::test;

namespace {

Impact random_impact(std::mt19937_64& engine, Parameters& p) {
    p = random_system(engine).parameters;
    p.R_plus = p.R_minus = uniform(engine, 0.1, 1);
    if (engine() % 2) p.table_plus = p.table_minus = random_table(engine, 0.01);
    Contact c{
        1,
        engine() % 2 ? 1 : -1,
        {uniform(engine, -.01, .01), uniform(engine, -.01, .01), std::sin(1.0), std::cos(1.0)},
        0};
    c.relative_speed = c.side * uniform(engine, 1e-4, 0.02);
    return impact_at(p, c, Flow::shared_free(p)->acceleration(c.lo), 1);
}

}  // namespace

TEST_CASE("an impact conserves momentum and reverses the relative velocity with factor R") {
    std::mt19937_64 engine(3);
    for (int n = 0; n < 1000; ++n) {
        Parameters p;
        const Impact i = random_impact(engine, p);
        CHECK(
            std::abs(
                i.x_dot_after + p.epsilon * i.y_dot_after - i.x_dot_before -
                p.epsilon * i.y_dot_before) < 1e-17);
        CHECK(
            std::abs(i.x_dot_after - i.y_dot_after + i.R * (i.x_dot_before - i.y_dot_before)) <
            1e-17);
        CHECK(
            i.impulse(p.epsilon) == doctest::Approx(i.x_dot_before - i.x_dot_after).epsilon(1e-9));
    }
}

TEST_CASE("the saltation matrix is eq. (27) with f from the flow") {
    std::mt19937_64 engine(4);
    for (int n = 0; n < 1000; ++n) {
        Parameters p;
        const Impact i = random_impact(engine, p);
        const Saltation m = saltation(p, i);
        const double x_ddot_after =
            i.x_ddot_before - 2 * p.zeta() * (i.x_dot_after - i.x_dot_before);
        const Eigen::Vector4d before(i.x_ddot_before, i.x_dot_before, 0, i.y_dot_before),
            after(x_ddot_after, i.x_dot_after, 0, i.y_dot_after);
        Matrix4 S;
        const double e = p.epsilon,
                     R = p.restitution_derivative(i.side, std::abs(i.relative_speed_before));
        S << (1 - R * e) / (1 + e), 0, (e + R * e) / (1 + e), 0, 0, 1, 0, 0, (1 + R) / (1 + e), 0,
            (e - R) / (1 + e), 0, 0, 0, 0, 1;
        const Matrix4 M =
            S - (S * before - after) * wall_normal().transpose() / wall_normal().dot(before);
        CHECK((m.matrix() - M).norm() < 1e-12 * M.norm());
        // The direction of the flow is mapped to that after the impact.
        CHECK((M * before - after).norm() < 1e-14);
    }
}

TEST_CASE(
    "|det M| = R d(R w)/dw and the moduli of its eigenvalues are 1, 1 and these two factors") {
    std::mt19937_64 engine(5);
    for (int n = 0; n < 1000; ++n) {
        Parameters p;
        const Impact i = random_impact(engine, p);
        const Matrix4 M = saltation(p, i).matrix();
        const double w = std::abs(i.relative_speed_before), d = 1e-6 * w,
                     R_speed = std::abs(
                                   (w + d) * p.restitution(i.side, w + d) -
                                   (w - d) * p.restitution(i.side, w - d)) /
                               (2 * d);
        // A corner of the law between the two speeds.
        if (p.restitution_derivative(i.side, w - d) - p.restitution_derivative(i.side, w + d) > 0.1)
            continue;
        CHECK(std::abs(M.determinant()) == doctest::Approx(i.R * R_speed).epsilon(1e-4));
        const Moduli sorted = eigenvalue_moduli(M);
        const Eigen::Vector4d moduli(sorted.data());
        Eigen::Vector4d expected(i.R, R_speed, 1, 1);
        std::sort(expected.begin(), expected.end(), std::greater<>());
        // Double eigenvalues: square root of the rounding.
        CHECK((moduli - expected).cwiseAbs().maxCoeff() < 1e-5 * M.norm());
    }
}

TEST_CASE("a nearly grazing impact is flagged, one on a pressing wall is not") {
    const Parameters p = table1(0.022, Damping::closed_form);
    const Oscillation lo{0.004, 0.001, 0, 1};
    CHECK(impact_at(p, {0, 1, lo, 1e-8}, -0.004, 0).grazing);
    CHECK_FALSE(impact_at(p, {0, 1, lo, 1e-8}, 0.004, 0).grazing);
    CHECK_FALSE(impact_at(p, {0, 1, lo, 1e-3}, -0.004, 0).grazing);
}
