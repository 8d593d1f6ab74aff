#include "core/motion/impact.hpp"

#include <Eigen/LU>
#include <cmath>

#include "core/motion/elementary.hpp"

namespace vines {

double Impact::phase() const {
    const double theta = elementary::atan2(sin_theta, cos_theta);
    return theta < 0 ? theta + 2 * std::numbers::pi : theta;
}

Impact impact_at(
    const Parameters& p, const Contact& contact, double x_ddot, double tau, double y_ddot) {
    const double w = contact.relative_speed, R = p.restitution(contact.side, std::abs(w));
    Impact i;
    i.tau = tau;
    i.side = contact.side;
    i.sin_theta = contact.lo.sin_theta;
    i.cos_theta = contact.lo.cos_theta;
    i.x = contact.lo.x;
    i.x_dot_before = contact.lo.x_dot;
    i.y_dot_before = contact.lo.x_dot - w;
    i.relative_speed_before = w;
    // Eq. (4): x'+ - y'+ = -R (x'- - y'-) and x'+ + epsilon y'+ = x'- + epsilon y'-.
    i.relative_speed_after = -R * w;
    i.x_dot_after = i.x_dot_before - (1 + R) * p.epsilon / (1 + p.epsilon) * w;
    i.y_dot_after = i.x_dot_after - i.relative_speed_after;
    i.x_ddot_before = x_ddot;
    i.y_ddot_before = y_ddot;
    i.R = R;
    // If a = x'' - y'' reverses side (x - y), b + w s - |a| s^2/2, its depth is w^2/(2 |a|).
    const double a = x_ddot - y_ddot;
    i.grazing = contact.side * a < 0 && w * w < 2 * std::abs(a) * grazing_depth * p.b;
    return i;
}

// S, eq. (25): the impact as a linear map of (x', x, y', y); positions are unchanged.
Matrix4 Saltation::S() const {
    Matrix4 S = Matrix4::Identity();
    S(0, 0) -= jump_x_dot, S(0, 2) += jump_x_dot;
    S(2, 0) += jump_y_dot, S(2, 2) -= jump_y_dot;
    return S;
}

// M = S + r g^T, eq. (27).
Matrix4 Saltation::matrix() const { return S() + r() * wall_normal().transpose(); }

double Saltation::condition() const {
    // M^-1 = S^-1 - S^-1 r g^T S^-1/(1 + g^T S^-1 r). S leaves positions unchanged and g depends on
    // them alone: g^T S^-1 = g^T and 1 + g^T r = -R, without large entries of r to cancel.
    if (is_singular()) return infinity;
    const Matrix4 S_inverse = S().inverse();
    return matrix().norm() * (S_inverse + S_inverse * r() * wall_normal().transpose() / R).norm();
}

Saltation saltation(const Parameters& p, const Impact& i) {
    const double R_speed =
        p.has_constant_R() ? i.R
                           : p.restitution_derivative(i.side, std::abs(i.relative_speed_before));
    const double jump_y = (1 + i.R) / (1 + p.epsilon), jump_x = p.epsilon * jump_y,
                 jump_y_dot = (1 + R_speed) / (1 + p.epsilon), jump_x_dot = p.epsilon * jump_y_dot;
    const double kappa = (i.x_ddot_before - i.y_ddot_before) / i.relative_speed_before;
    // r = (f+ - S f-)/(x'- - y'-) with f = (x'', x', y'', y'), eq. (27): a deviation shifts the
    // impact in time. x'' jumps by -2 zeta (x'+ - x'-), velocities by jump_x, jump_y times (x'- -
    // y'-). Friction reverses: y'' jumps by -2 friction side, x'' by -epsilon times that.
    const double friction = p.friction == 0 ? 0 : 2 * p.friction * i.side / i.relative_speed_before;
    const double two_zeta = 2 * p.zeta();
    return {
        .R = i.R,
        .R_speed = R_speed,
        .jump_x = jump_x,
        .jump_y = jump_y,
        .jump_x_dot = jump_x_dot,
        .jump_y_dot = jump_y_dot,
        .r_x = jump_x_dot * (kappa + two_zeta) + (jump_x - jump_x_dot) * two_zeta +
               p.epsilon * friction,
        .r_y = -jump_y_dot * kappa - friction};
}

Saltation saltation(double epsilon, const Slip& slip) {
    const double jump_y_dot = (1 - slip.ratio) / (1 + epsilon);
    return {
        .R = -1,
        .R_speed = -slip.ratio,
        .jump_x = 0,
        .jump_y = 0,
        .jump_x_dot = epsilon * jump_y_dot,
        .jump_y_dot = jump_y_dot,
        .r_x = 0,
        .r_y = 0};
}

}  // namespace vines
