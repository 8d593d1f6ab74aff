// Impact: reset map S of velocities (4), (25), saltation matrix M of deviations (26), (27), (36).
#pragma once

#include <Eigen/Core>

#include "core/motion/contact_search.hpp"

namespace vines {

/// Matrices act on deviations in the order (x', x, y', y), eq. (5).
using Matrix4 = Eigen::Matrix4d;

inline Eigen::Vector4d vector_of(const State& s) { return {s.x_dot, s.x, s.y_dot, s.y}; }
inline State state_of(const Eigen::Vector4d& v) { return {v(0), v(1), v(2), v(3)}; }

/// Four deviations as columns, stored by rows: one operation treats a component of all four.
using Frame = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// One impact. Velocities in m per unit of tau; `relative_speed_*` is x' - y'.
struct Impact {
    double tau;
    int side;                     ///< sign of x - y
    double sin_theta, cos_theta;  ///< phasor of the forcing phase theta = Omega tau + phi
    double x;
    double x_dot_before, x_dot_after, y_dot_before, y_dot_after;
    double relative_speed_before, relative_speed_after;
    double x_ddot_before;
    double y_ddot_before = 0;  ///< zero without gravity and friction
    double R;                  ///< restitution coefficient of this side at this speed
    bool grazing;              ///< nearly grazing: see grazing_depth

    double phase() const;  ///< theta in [0, 2 pi)
    /// Impulse on the ball divided by m1, m per unit of tau.
    double impulse(double epsilon) const { return epsilon * (y_dot_after - y_dot_before); }
};

/// The ball comes to rest relative to the oscillator while it slides.
struct Slip {
    double tau;
    /// x'' - y'' after it over that before; 0 if the ball then rests inside the cavity.
    double ratio;
};

/// Depth, in units of b, below which the ball would have turned back at a grazing impact.
inline constexpr double grazing_depth = 1e-9;

/// The impact at a contact, eq. (4): conserves x' + epsilon y', reverses x' - y' with factor R.
Impact impact_at(
    const Parameters& parameters, const Contact& contact, double x_ddot, double tau,
    double y_ddot = 0);

/// M = S + r g^T with g^T = [0 1 0 -1] (23) and r = (f+ - S f-)/(g^T f-), eq. (27), where S is the
/// derivative of the impact law (25). Stored by its factors: every determinant is linear in them.
struct Saltation {
    double R;        ///< factor for x - y
    double R_speed;  ///< factor for x' - y': d(R w)/dw, R for a constant R
    /// (1 + R) epsilon/(1 + epsilon) and (1 + R)/(1 + epsilon): jumps of velocities over x' - y'.
    double jump_x, jump_y;
    double jump_x_dot, jump_y_dot;  ///< the same with R_speed, for deviations of the velocities
    double r_x, r_y;                ///< entries 0 and 2 of r; they contain x''/(x'- - y'-)

    double determinant() const { return R * R_speed; }
    bool is_singular() const { return R == 0 || R_speed == 0; }
    Matrix4 S() const;  ///< eq. (25), with R_speed
    Eigen::Vector4d r() const { return {r_x, -jump_x, r_y, jump_y}; }
    Matrix4 matrix() const;
    /// matrix() * deviations, in 13 operations per deviation.
    template <class Deviations>
    Deviations times(const Deviations& d) const {
        using Row = Eigen::Matrix<double, 1, Deviations::ColsAtCompileTime>;
        const Row rate = d.row(0) - d.row(2), gap = d.row(1) - d.row(3);
        Deviations out;
        out.row(0) = d.row(0) - jump_x_dot * rate + r_x * gap;
        out.row(1) = d.row(1) - jump_x * gap;
        out.row(2) = d.row(2) + jump_y_dot * rate + r_y * gap;
        out.row(3) = d.row(3) + jump_y * gap;
        return out;
    }
    /// Condition number in the Frobenius norm; grows as (x''/(x'- - y'-))^2, infinite for R = 0.
    double condition() const;
};

/// The vector g of eq. (23): d(x - y)/dPhi, normal to both walls in state space.
inline Eigen::Vector4d wall_normal() { return {0, 1, 0, -1}; }

/// Multiplies deviations of x' - y' by `ratio`; those of positions and centre of mass stay.
Saltation saltation(double epsilon, const Slip& slip);

/// Saltation matrix of an impact. M has eigenvalues of moduli 1, 1, R, R_speed.
Saltation saltation(const Parameters& parameters, const Impact& impact);

}  // namespace vines
