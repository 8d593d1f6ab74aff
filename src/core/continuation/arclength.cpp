#include "core/continuation/arclength.hpp"

#include <Eigen/LU>
#include <cmath>

namespace vines {

namespace {

// Newton's method: largest number of steps, and the step after which only rounding remains. A step
// below `last_correction` leaves an error of its square, once the residual before it is small: next
// to an event without speed derivatives are large, and change within a step.
constexpr int most_corrections = 8;
constexpr double last_correction = 1e-8, rounding_step = 1e-14, converged_residual = 1e-10;
constexpr int most_evaluations = 60;

/// The Jacobian with a last row.
Eigen::MatrixXd bordered(const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& row) {
    Eigen::MatrixXd square(jacobian.cols(), jacobian.cols());
    square.topRows(jacobian.rows()) = jacobian;
    square.bottomRows<1>() = row.transpose();
    return square;
}

}  // namespace

std::optional<Eigen::VectorXd> tangent_of(
    const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& along) {
    const Eigen::PartialPivLU<Eigen::MatrixXd> solver(bordered(jacobian, along));
    Eigen::VectorXd tangent = solver.solve(Eigen::VectorXd::Unit(along.size(), along.size() - 1));
    const double length = tangent.norm();
    if (!(length > 0) || !std::isfinite(length)) return std::nullopt;
    return tangent / length;
}

std::optional<CurvePoint> point_in_plane(
    const CurveEquations& equations, const Eigen::VectorXd& guess, const Eigen::VectorXd& normal,
    double offset) {
    CurvePoint at{guess, {}};
    Eigen::VectorXd residual, right(guess.size());
    Eigen::MatrixXd jacobian;
    double before = 1e300;
    for (int step = 0; step < most_corrections; ++step) {
        if (!equations(at.z, residual, &jacobian)) return std::nullopt;
        right << residual, normal.dot(at.z) - offset;
        const Eigen::VectorXd correction =
            Eigen::PartialPivLU<Eigen::MatrixXd>(bordered(jacobian, normal)).solve(right);
        const double size = correction.cwiseAbs().maxCoeff();
        if (!(size < last_correction || size < 2 * before)) return std::nullopt;  // also NaN
        at.z -= correction;
        const bool has_converged =
            before < last_correction && residual.cwiseAbs().maxCoeff() < converged_residual;
        if (size < last_correction && (size < rounding_step || has_converged)) {
            const auto tangent = tangent_of(jacobian, normal);
            if (!tangent) return std::nullopt;
            at.tangent = *tangent;
            return at;
        }
        before = size;
    }
    return std::nullopt;
}

std::optional<double> sign_change(
    const std::function<std::optional<double>(double)>& f, double a, double f_a, double b,
    double f_b, double tolerance) {
    for (int k = 0; k < most_evaluations && std::abs(b - a) > tolerance; ++k) {
        double c = b - f_b * (b - a) / (f_b - f_a);
        if (k % 4 == 3 || !(c > std::min(a, b) && c < std::max(a, b))) c = 0.5 * (a + b);
        const auto f_c = f(c);
        if (!f_c) return std::nullopt;
        if (*f_c == 0) return c;
        if (std::signbit(*f_c) != std::signbit(f_b)) a = b, f_a = f_b;
        else f_a *= 0.5;  // Illinois: the other end was kept twice
        b = c, f_b = *f_c;
    }
    return b;
}

}  // namespace vines
