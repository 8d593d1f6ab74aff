// Pseudo-arclength continuation (Keller, 1977): m smooth equations in m + 1 unknowns define curves;
// a step predicts along the tangent and corrects by Newton's method in a hyperplane. Folds are
// ordinary points of such a curve.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

namespace vines {

/// Residual of m equations and, unless null, their m x (m + 1) Jacobian; false outside the domain.
using CurveEquations =
    std::function<bool(const Eigen::VectorXd& z, Eigen::VectorXd& residual, Eigen::MatrixXd* J)>;

/// A point of a curve with its unit tangent.
struct CurvePoint {
    Eigen::VectorXd z, tangent;
};

/// The point of the curve near `guess` in the hyperplane normal . z = offset, with its tangent on
/// the side of `normal`. Empty if Newton's method does not converge within a few steps. The
/// remaining error is that of rounding.
std::optional<CurvePoint> point_in_plane(
    const CurveEquations& equations, const Eigen::VectorXd& guess, const Eigen::VectorXd& normal,
    double offset);

/// Unit tangent from a Jacobian, on the side of `along`; empty if it is not unique.
std::optional<Eigen::VectorXd> tangent_of(
    const Eigen::MatrixXd& jacobian, const Eigen::VectorXd& along);

/// A sign change of f between a and b, where its values are f_a and f_b, to within `tolerance`:
/// false position (Illinois), which keeps a bracket. Empty where f is.
std::optional<double> sign_change(
    const std::function<std::optional<double>(double)>& f, double a, double f_a, double b,
    double f_b, double tolerance);

}  // namespace vines
