#include "report/symmetric_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/stability/linear.hpp"

namespace vines::report {

namespace {

/// A quantity linear in V.
struct LinearInV {
    double constant, slope;
    double at(double V) const { return constant + slope * V; }
};

/// The impact at x - y = +b and the flight to x - y = -b, half a cycle later, after which
/// everything is reversed. The ball flies 2 (b - x) in pi/Omega, and the impact law (4) gives x' on
/// both sides.
struct HalfCycle {
    explicit HalfCycle(const Parameters& p)
        : duration(std::numbers::pi / p.Omega),
          x{p.b, -duration / 2},
          x_dot_before{0, (1 - p.R_plus + 2 * p.epsilon) / (1 + p.R_plus)},
          x_dot_after{0, x_dot_before.slope - 2 * p.epsilon} {}

    double duration;
    LinearInV x, x_dot_before, x_dot_after;
};

/// Forced part (x', x) of the motion at the impact of the + wall. The free part after the impact,
/// carried over half a cycle, is minus the free part before it.
Eigen::Vector2d forced_part(const HalfCycle& h, const Transfer& J, double V) {
    const Eigen::Matrix2d A{{J.a11, J.a12}, {J.a21, J.a22}};
    const Eigen::Vector2d after(h.x_dot_after.at(V), h.x.at(V)),
        before(h.x_dot_before.at(V), h.x.at(V));
    const Eigen::Matrix2d sum = A + Eigen::Matrix2d::Identity();
    const double det = sum(0, 0) * sum(1, 1) - sum(0, 1) * sum(1, 0);
    const Eigen::Matrix2d inverse =
        Eigen::Matrix2d{{sum(1, 1), -sum(0, 1)}, {-sum(1, 0), sum(0, 0)}} / det;
    return inverse * (A * after + before);
}

/// x'' before the impact: the forced part x = X sin + Y cos has x'' = -Omega^2 x, and the free part
/// obeys x'' = -2 zeta x' - x.
double acceleration_before(
    const Parameters& p, const Eigen::Vector2d& forced, double x_dot, double x) {
    return -p.Omega * p.Omega * forced[1] - 2 * p.zeta() * (x_dot - forced[0]) - (x - forced[1]);
}

SymmetricMotion motion_at(const Parameters& p, const HalfCycle& h, const Flow& flow, double V) {
    const Transfer J = flow.transfer(h.duration);
    const double x = h.x.at(V), x_dot = h.x_dot_before.at(V);
    Impact impact{};
    impact.side = 1;
    impact.x = x;
    impact.x_dot_before = x_dot, impact.x_dot_after = h.x_dot_after.at(V);
    impact.y_dot_before = -V, impact.y_dot_after = V;
    impact.relative_speed_before = x_dot + V;
    impact.relative_speed_after = impact.x_dot_after - V;
    impact.x_ddot_before = acceleration_before(p, forced_part(h, J, V), x_dot, x);
    impact.R = p.R_plus;
    const Matrix4 map =
        -saltation(p, impact).matrix() * transfer_of(leg_of(flow, h.duration, false), p.epsilon);
    const Eigen::Vector4cd values = eigenvalues_of(map);
    SymmetricMotion motion{V, {values[0], values[1], values[2], values[3]}};
    std::ranges::sort(motion.multipliers, [](const auto& a, const auto& b) {
        return elementary::modulus(a) > elementary::modulus(b);
    });
    return motion;
}

}  // namespace

/// Solves for V. The amplitude of the forced part is epsilon A / sqrt(D), which is a quadratic
/// equation for V.
std::optional<SymmetricMotion> fast_symmetric_motion(const Parameters& p) {
    const HalfCycle h(p);
    const Flow flow = Flow::free(p);
    const Transfer J = flow.transfer(h.duration);
    const Eigen::Vector2d scale(1 / p.Omega, 1),
        constant = forced_part(h, J, 0).cwiseProduct(scale),
        slope = forced_part(h, J, 1).cwiseProduct(scale) - constant;
    const double O2 = p.Omega * p.Omega, zeta = p.zeta(),
                 D = (1 - O2) * (1 - O2) + 4 * zeta * zeta * O2, force = p.epsilon * p.A();
    const double a = slope.squaredNorm(), half_b = slope.dot(constant),
                 c = constant.squaredNorm() - force * force / D;
    const double discriminant = half_b * half_b - a * c;
    if (discriminant < 0) return std::nullopt;
    const double V = (-half_b + std::sqrt(discriminant)) / a;
    if (V <= 0) return std::nullopt;
    return motion_at(p, h, flow, V);
}

}  // namespace vines::report
