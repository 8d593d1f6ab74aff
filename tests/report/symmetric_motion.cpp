#include "symmetric_motion.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

namespace vines::report {

namespace {

double half_cycle(const Parameters& p) { return std::numbers::pi / p.Omega; }

/// The oscillator at the impact at x - y = +b. The flight to x - y = -b takes half a cycle, after
/// which everything is reversed. The ball flies 2 (b - x) in that time, and the impact law (4)
/// gives x' on both sides.
struct WallImpact {
    WallImpact(const Parameters& p, double V)
        : x(p.b - V * half_cycle(p) / 2),
          x_dot_before(V * (1 - p.R_plus + 2 * p.epsilon) / (1 + p.R_plus)),
          x_dot_after(x_dot_before - 2 * p.epsilon * V) {}

    double x, x_dot_before, x_dot_after;
};

/// Forced part (x', x) of the motion at that impact; linear in V. The free part after the impact,
/// carried over half a cycle, is minus the free part before it.
Eigen::Vector2d forced_part(const WallImpact& i, const Transfer& J) {
    const Eigen::Matrix2d A{{J.a11, J.a12}, {J.a21, J.a22}};
    const Eigen::Vector2d after(i.x_dot_after, i.x), before(i.x_dot_before, i.x);
    return (A + Eigen::Matrix2d::Identity()).inverse() * (A * after + before);
}

/// x'' before the impact: the forced part x = X sin + Y cos has x'' = -Omega^2 x, and the free part
/// obeys x'' = -2 zeta x' - x.
double acceleration_before(
    const Parameters& p, const Eigen::Vector2d& forced, double x_dot, double x) {
    return -p.Omega * p.Omega * forced[1] - 2 * p.zeta() * (x_dot - forced[0]) - (x - forced[1]);
}

SymmetricMotion motion_at(const Parameters& p, const Flow& flow, double V) {
    const WallImpact wall(p, V);
    const Eigen::Vector2d forced = forced_part(wall, flow.transfer(half_cycle(p)));
    Impact impact{};
    impact.side = 1;
    impact.x = wall.x;
    impact.x_dot_before = wall.x_dot_before, impact.x_dot_after = wall.x_dot_after;
    impact.y_dot_before = -V, impact.y_dot_after = V;
    impact.relative_speed_before = wall.x_dot_before + V;
    impact.relative_speed_after = wall.x_dot_after - V;
    impact.x_ddot_before = acceleration_before(p, forced, wall.x_dot_before, wall.x);
    impact.R = p.R_plus;
    const Matrix4 map =
        -saltation(p, impact).matrix() * transfer_of(leg_of(flow, half_cycle(p), false), p.epsilon);
    return {V, eigenvalues_of(map)};
}

}  // namespace

/// Solves for V. The amplitude of the forced part is epsilon A / sqrt(D), which is a quadratic
/// equation for V.
std::optional<SymmetricMotion> fast_symmetric_motion(const Parameters& p) {
    const Flow flow = *Flow::shared_free(p);
    const Transfer J = flow.transfer(half_cycle(p));
    const Eigen::Vector2d scale(1 / p.Omega, 1),
        constant = forced_part({p, 0}, J).cwiseProduct(scale),
        slope = forced_part({p, 1}, J).cwiseProduct(scale) - constant;
    const double O2 = p.Omega * p.Omega, zeta = p.zeta(),
                 D = (1 - O2) * (1 - O2) + 4 * zeta * zeta * O2, force = p.epsilon * p.A();
    const double a = slope.squaredNorm(), half_b = slope.dot(constant),
                 c = constant.squaredNorm() - force * force / D;
    const double discriminant = half_b * half_b - a * c;
    if (discriminant < 0) return std::nullopt;
    const double V = (-half_b + std::sqrt(discriminant)) / a;
    if (V <= 0) return std::nullopt;
    return motion_at(p, flow, V);
}

}  // namespace vines::report
