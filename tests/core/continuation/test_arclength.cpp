#include <doctest/doctest.h>

#include <cmath>

#include "core/continuation/arclength.hpp"

using namespace vines;

namespace {

/// The unit circle.
bool circle(const Eigen::VectorXd& z, Eigen::VectorXd& residual, Eigen::MatrixXd* J) {
    residual = Eigen::VectorXd::Constant(1, z.squaredNorm() - 1);
    if (J) *J = 2 * z.transpose();
    return z(0) > -0.5;  // the equations' domain
}

}  // namespace

TEST_CASE("a step along a tangent ends on the curve and in its plane, also at a fold") {
    CurvePoint at{Eigen::Vector2d(0, 1), Eigen::Vector2d(1, 0)};
    for (int step = 0; step < 20; ++step) {
        const auto next =
            point_in_plane(circle, at.z + 0.1 * at.tangent, at.tangent, at.tangent.dot(at.z) + 0.1);
        REQUIRE(next);
        CHECK(std::abs(next->z.norm() - 1) < 1e-15);
        CHECK(std::abs(at.tangent.dot(next->z - at.z) - 0.1) < 1e-15);
        CHECK(std::abs(next->tangent.dot(next->z)) < 1e-12);
        CHECK(next->tangent.dot(at.tangent) > 0.99);
        at = *next;
    }
    CHECK(at.z(1) < -0.4);  // beyond the fold at (1, 0)
}

TEST_CASE("there is no point outside of the equations' domain or without a solution") {
    const Eigen::Vector2d along(1, 0);
    CHECK(!point_in_plane(circle, Eigen::Vector2d(-0.9, 0.4), along, -0.9));
    CHECK(!point_in_plane(circle, Eigen::Vector2d(1.5, 0.1), along, 1.5));
}

TEST_CASE("a sign change is found to the tolerance, also next to a flat end") {
    int evaluations = 0;
    const auto f = [&](double x) -> std::optional<double> {
        ++evaluations;
        return std::pow(x, 9) - 1e-3;
    };
    const auto root = sign_change(f, 0, -1e-3, 2, 512 - 1e-3, 1e-13);
    REQUIRE(root);
    CHECK(*root == doctest::Approx(std::pow(1e-3, 1.0 / 9)).epsilon(1e-12));
    CHECK(evaluations < 60);
    CHECK(!sign_change([](double) { return std::optional<double>(); }, 0, -1, 1, 1, 1e-3));
}
