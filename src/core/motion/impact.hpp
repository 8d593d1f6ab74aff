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

/// M = S + r g^T with g^T = [0 1 0 -1] (23) and r = (f+ - S f-)/(g^T f-), eq. (27). Kept as what
/// its entries are made of, because those of r grow without bound towards grazing while every
/// determinant of M is linear in them.
struct Saltation {
    double R;
    double on_x, on_y;      ///< shares (1 + R) epsilon/(1 + epsilon) and (1 + R)/(1 + epsilon)
    double turn_x, turn_y;  ///< entries 0 and 2 of r: they hold x''/(x'- - y'-)

    Matrix4 S() const;  ///< eq. (25)
    Eigen::Vector4d r() const { return {turn_x, -on_x, turn_y, on_y}; }
    Matrix4 matrix() const;
    /// matrix() * deviations, by rows, in 13 operations a deviation.
    template <class Deviations>
    Deviations times(const Deviations& d) const {
        using Row = Eigen::Matrix<double, 1, Deviations::ColsAtCompileTime>;
        const Row rate = d.row(0) - d.row(2), gap = d.row(1) - d.row(3);
        Deviations out;
        out.row(0) = d.row(0) - on_x * rate + turn_x * gap;
        out.row(1) = d.row(1) - on_x * gap;
        out.row(2) = d.row(2) + on_y * rate + turn_y * gap;
        out.row(3) = d.row(3) + on_y * gap;
        return out;
    }
    /// Condition number in the Frobenius norm: by how much M may magnify a relative error. It grows
    /// as (x''/(x'- - y'-))^2 towards grazing; infinite for R = 0.
    double condition() const;
};

/// The vector g of eq. (23): d(x - y)/dPhi, normal to both walls in the space of states.
Eigen::Vector4d wall_normal();

/// Where S does not change in time M has determinant R^2 and eigenvalues of moduli 1, 1, R, R.
Saltation saltation(const Parameters& parameters, const Impact& impact);

}  // namespace vines
