#include "core/measures/manifold.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/measures/energy.hpp"

namespace vines {

namespace {

constexpr double quarter_turn = std::numbers::pi / 2;

// Rounding can move the end of a window's last half cycle past the window, relative to tau_end.
constexpr double window_rounding = 1e-12;

double k_of(double R) { return (1 - R) / (1 + R); }

}  // namespace

double manifold_C(double R, double Omega, double b, double V) {
    assert(R >= 0 && R <= 1 && Omega > 0 && V >= 0);
    const double W = V / Omega;
    return elementary::hypot(quarter_turn * W - b, k_of(R) * W);
}

ManifoldPoint manifold_fold(double R, double Omega, double b) {
    // dC/dW = 0: W = (pi/2) b/(pi^2/4 + k^2)
    const double k = k_of(R), norm = quarter_turn * quarter_turn + k * k;
    return {b * k / std::sqrt(norm), Omega * quarter_turn * b / norm};
}

ManifoldPoint manifold_symmetry_breaking(double R, double Omega, double b) {
    // An eigenvalue of half a cycle is -1: W = (pi/2) b/(pi^2/4 - 1)
    const double V = Omega * quarter_turn * b / (quarter_turn * quarter_turn - 1);
    return {manifold_C(R, Omega, b, V), V};
}

ManifoldPoint manifold_second_contact(double R, double Omega, double b) {
    // Half the contact's time, where tan(u) = (1 + R) u; tan(u)/u >= 1 + u^2/3 bounds it above.
    double below = 0, u = std::min(quarter_turn, std::sqrt(3 * R));
    for (double middle = u / 2; middle > below && middle < u; middle = below + (u - below) / 2)
        (elementary::sin(middle) < (1 + R) * middle * elementary::cos(middle) ? below : u) = middle;
    // (1 - k cos t)/sin t, written without cancellation.
    const double sin_u = elementary::sin(u),
                 q = u > 0 ? (R / (1 + R) + k_of(R) * sin_u * sin_u) / (sin_u * elementary::cos(u))
                           : 0;
    const double V = Omega * b / (quarter_turn - q);
    return {manifold_C(R, Omega, b, V), V};
}

double manifold_b(double R, double C) {
    const double k = k_of(R);
    return k > 0 ? C * std::sqrt(quarter_turn * quarter_turn + k * k) / k : 0;
}

Manifold manifold_of(const Parameters& p, double V_max, std::size_t points) {
    assert(p.R_plus == p.R_minus && points >= 2);
    const double R = p.R_plus;
    const ManifoldPoint fold = manifold_fold(R, p.Omega, p.b),
                        breaking = manifold_symmetry_breaking(R, p.Omega, p.b),
                        contact = manifold_second_contact(R, p.Omega, p.b);
    const double last = std::min(V_max > 0 ? V_max : 2 * breaking.V, contact.V);
    // Equidistant in V.
    auto branch = [&](double from, double to) {
        std::vector<ManifoldPoint> curve;
        for (std::size_t i = 0; from < to && i < points; ++i) {
            const double V =
                std::lerp(from, to, static_cast<double>(i) / static_cast<double>(points - 1));
            curve.push_back({manifold_C(R, p.Omega, p.b, V), V});
        }
        return curve;
    };
    const auto free = free_amplitude(p);
    return {
        .R = R,
        .Omega = p.Omega,
        .b = p.b,
        .fold = fold,
        .symmetry_breaking = breaking.V < contact.V ? std::optional(breaking) : std::nullopt,
        .second_contact = contact,
        .stable = branch(fold.V, std::min(breaking.V, contact.V)),
        .unstable = branch(0, fold.V),
        .asymmetric = branch(breaking.V, last),
        .free_amplitude = free,
        .b_at_free_amplitude = free && R < 1 ? std::optional(manifold_b(R, *free)) : std::nullopt};
}

void HalfCycles::on_stretch(const Stretch& stretch) {
    for (double from = std::max(0.0, begun_ - stretch.tau); from < stretch.duration;) {
        const double end = next_ * half_cycle_ - stretch.tau;
        pass(stretch, from, std::min(end, stretch.duration));
        if (end > stretch.duration) return;
        if (next_ * half_cycle_ <= window_.to * (1 + window_rounding)) {
            tau.push_back(next_ * half_cycle_);
            points.push_back({peak_, path_ / half_cycle_});
            keep_last(tau, most_);
            keep_last(points, most_);
        }
        peak_ = path_ = 0;
        ++next_;
        from = std::max(end, 0.0);
    }
}

void HalfCycles::pass(const Stretch& stretch, double from, double to) {
    if (!(from < to)) return;
    const Flow& flow = stretch.flow;
    const Polynomial shift = stretch.shift();
    peak_ = peak_beyond(peak_, flow, stretch.start, shift, from, to);
    if (stretch.is_joint()) {
        path_ += path_length(flow, stretch.start, shift, from, to);
        return;
    }
    const double y_ddot = stretch.forces ? stretch.forces->y_ddot : 0;
    if (y_ddot == 0) {
        path_ += std::abs(stretch.y_dot) * (to - from);
        return;
    }
    // Gravity and friction turn the ball once at most.
    const double turn = std::clamp(-stretch.y_dot / y_ddot, from, to);
    path_ += std::abs(stretch.at(turn).y - stretch.at(from).y) +
             std::abs(stretch.at(to).y - stretch.at(turn).y);
}

}  // namespace vines
