// The impact: reset map S of the velocities (4), (25) and saltation matrix M of the deviations
// (26), (27), (36).
#pragma once

#include <Eigen/Core>

#include "core/motion/guard.hpp"

namespace vines {

/// Matrices act on deviations in the paper's order (x', x, y', y), eq. (5).
using Matrix4 = Eigen::Matrix4d;

/// Deviations as columns, stored by rows: what happens to one of their components happens to those
/// of all four at once.
using Frame = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// Everything known of one impact. Velocities in m per unit of tau; `relative_speed_*` is x' - y'.
struct Impact {
    double tau;
    int side;                     ///< sign of x - y
    double sin_theta, cos_theta;  ///< phasor of the forcing phase theta = Omega tau + phi
    double x;
    double x_dot_before, x_dot_after, y_dot_before, y_dot_after;
    double relative_speed_before, relative_speed_after;
    double x_ddot_before;
    double R;      ///< restitution coefficient of this side
    bool grazing;  ///< nearly tangent: see grazing_depth

    double phase() const;  ///< theta in [0, 2 pi)
    /// On the free mass, per m1, m.
    double impulse(double epsilon) const { return epsilon * (y_dot_after - y_dot_before); }
};

/// An impact is called grazing if, without the wall, the mass would have passed the wall's place by
/// less than this share of b and turned back.
inline constexpr double grazing_depth = 1e-9;

/// The velocities after a contact, eq. (4): x' + epsilon y' kept, x' - y' reversed with factor R.
Impact impact_at(const Parameters& parameters, const Contact& contact, double x_ddot, double tau);

/// M = S + r g^T with g^T = [0 1 0 -1] (23) and r = (f+ - S f-)/(g^T f-), eq. (27). Kept as its two
/// parts, because the entries of r grow without bound towards grazing while every determinant of M
/// is linear in r.
struct Saltation {
    Matrix4 S;          ///< eq. (25)
    Eigen::Vector4d r;  ///< entries 0 and 2 hold x''/(x'- - y'-)

    Matrix4 matrix() const;
    /// matrix() * deviations, with a third of the multiplications.
    Frame times(const Frame& deviations) const;
    /// Condition number in the Frobenius norm: by how much M may magnify a relative error. It grows
    /// as (x''/(x'- - y'-))^2 towards grazing; infinite for R = 0.
    double condition(double R) const;
};

/// The vector g of eq. (23): d(x - y)/dPhi, normal to both walls in the space of states.
Eigen::Vector4d wall_normal();

/// Where S does not change in time M has determinant R^2 and eigenvalues of moduli 1, 1, R, R.
Saltation saltation(const Parameters& parameters, const Impact& impact);

}  // namespace vines
