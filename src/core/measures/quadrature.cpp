#include "core/measures/quadrature.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Gauss-Legendre on [0, 1]; over one cell the error of x'^2 is below 1e-16.
struct Node {
    double at, weight;
};
constexpr std::array<Node, 5> gauss = {
    {{0.046910077030668004, 0.11846344252809454},
     {0.23076534494715845, 0.23931433524968324},
     {0.5, 0.28444444444444444},
     {0.76923465505284155, 0.23931433524968324},
     {0.95308992296933200, 0.11846344252809454}}};

Eigen::Vector4d vector(const Oscillation& o) { return {o.x, o.x_dot, o.sin_theta, o.cos_theta}; }

// A slower decay or rotation, per unit of tau, would need windows longer than any run.
constexpr double slowest = 1e-3;

/// Slowest rate at which products of two of the four components change, except the constant sin^2 +
/// cos^2: sums of two eigenvalues of L.
double slowest_rate(const Flow::Coefficients& c) {
    const auto [stiffness, damping, forcing, Omega] = c;
    const double half = 0.5 * damping, turning = stiffness - half * half;
    if (turning > 0)
        return std::min({damping, elementary::hypot(half, std::sqrt(turning) - Omega), 2 * Omega});
    const double slow = half - std::sqrt(-turning);
    return std::min({2 * slow, elementary::hypot(slow, Omega), 2 * Omega});
}

using Wide = long double;
using WideForm = Eigen::Matrix<Wide, 4, 4>;

/// Indices of the ten entries of a symmetric form.
constexpr std::array<std::array<int, 2>, 10> places = {
    {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {1, 1}, {1, 2}, {1, 3}, {2, 2}, {2, 3}, {3, 3}}};

WideForm symmetric(int place) {
    WideForm m = WideForm::Zero();
    const auto [i, j] = places[place];
    m(i, j) = m(j, i) = 1;
    return m;
}

}  // namespace

std::optional<Antiderivative> Antiderivative::of(const Flow& flow) {
    thread_local SmallCache<Flow::Coefficients, std::optional<Antiderivative>> antiderivatives;
    return *antiderivatives.get(flow.coefficients(), [&flow] { return solved_for(flow); });
}

std::optional<Antiderivative> Antiderivative::solved_for(const Flow& flow) {
    const Flow::Coefficients c = flow.coefficients();
    const double rate = slowest_rate(c);
    if (!(rate > slowest)) return {};
    const auto [stiffness, damping, forcing, Omega] = c;
    WideForm L;
    L << 0, 1, 0, 0, -stiffness, -damping, forcing, 0, 0, 0, 0, Omega, 0, 0, -Omega, 0;
    // Unknowns: the entries of P, without its constant part sin^2 + cos^2, and the rate.
    Eigen::Matrix<Wide, 11, 11> system = Eigen::Matrix<Wide, 11, 11>::Zero();
    for (int k = 0; k < 10; ++k) {
        const WideForm P = symmetric(k), changes = L.transpose() * P + P * L;
        for (int row = 0; row < 10; ++row) system(row, k) = changes(places[row][0], places[row][1]);
    }
    system(7, 10) = system(9, 10) = 1;
    system(10, 7) = system(10, 9) = 1;
    const Eigen::FullPivLU<Eigen::Matrix<Wide, 11, 11>> factors(system);
    Antiderivative F;
    // Entries of the integrands: x^2, x'^2 and x' sin(theta).
    constexpr std::pair<int, Wide> entries[] = {{0, 1}, {4, 1}, {5, 0.5L}};
    for (int k = 0; k < 3; ++k) {
        Eigen::Matrix<Wide, 11, 1> Q = Eigen::Matrix<Wide, 11, 1>::Zero();
        Q(entries[k].first) = entries[k].second;
        const Eigen::Matrix<Wide, 11, 1> solution = factors.solve(Q);
        WideForm P = WideForm::Zero();
        for (int place = 0; place < 10; ++place) P += solution(place) * symmetric(place);
        F.P_[k] = P.cast<double>();
        F.rate_(k) = static_cast<double>(solution(10));
    }
    F.settled_ = 2 * std::numbers::pi + 1 / rate;
    return F;
}

Integrals Antiderivative::at(const Oscillation& o) const {
    const Eigen::Vector4d z = vector(o);
    return {z.dot(P_[0] * z), z.dot(P_[1] * z), z.dot(P_[2] * z)};
}

Integrals Antiderivative::across(const Oscillation& o, double x_dot_before) const {
    Integrals jump;
    for (int k = 0; k < 3; ++k) {
        const Eigen::Matrix4d& P = P_[k];
        jump(k) = (x_dot_before - o.x_dot) *
                  (P(1, 1) * (x_dot_before + o.x_dot) +
                   2 * (P(1, 0) * o.x + P(1, 2) * o.sin_theta + P(1, 3) * o.cos_theta));
    }
    return jump;
}

Quadrature::Quadrature(const Flow& flow) : flow_(flow) {
    const Oscillation unit[4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};
    // The forms of one cell, in terms of the state at its start.
    const Eigen::Matrix4d zero = Eigen::Matrix4d::Zero();
    Forms cell = {zero, zero, zero};
    from_start_.push_back(cell);
    for (const Node& node : gauss) {
        const double d = node.at * flow.cell(), weight = node.weight * flow.cell();
        Eigen::Vector4d x, x_dot, sin;
        for (int j = 0; j < 4; ++j) {
            const Oscillation o = flow.along(flow.series(unit[j]), unit[j], d);
            x(j) = o.x, x_dot(j) = o.x_dot, sin(j) = o.sin_theta;
        }
        cell[x_squared] += weight * x * x.transpose();
        cell[x_dot_squared] += weight * x_dot * x_dot.transpose();
        cell[x_dot_sin] += weight * x_dot * sin.transpose();
    }
    for (int k = 0; k < Flow::cells; ++k) {
        Eigen::Matrix4d over;
        for (int j = 0; j < 4; ++j) over.col(j) = vector(flow.at(unit[j], k));
        Forms next = from_start_.back();
        for (int i = 0; i < 3; ++i) next[i] += over.transpose() * cell[i] * over;
        from_start_.push_back(next);
    }
}

std::shared_ptr<const Quadrature> Quadrature::shared(const Flow& flow) {
    thread_local SmallCache<Flow::Coefficients, Quadrature> quadratures;
    return quadratures.get(flow.coefficients(), [&flow] { return Quadrature(flow); });
}

Integrals Quadrature::over_part(const Oscillation& start, double duration) const {
    const Flow::TaylorSeries series = flow_.series(start);
    Integrals sum = Integrals::Zero();
    for (const Node& node : gauss) {
        const Oscillation o = flow_.along(series, start, node.at * duration);
        const double x_dot = node.weight * o.x_dot;
        sum += Integrals(node.weight * o.x * o.x, x_dot * o.x_dot, x_dot * o.sin_theta);
    }
    return sum * duration;
}

Integrals Quadrature::over_grid(const Oscillation& start, int cells) const {
    const Eigen::Vector4d z = vector(start);
    const Forms& f = from_start_[cells];
    return {z.dot(f[0] * z), z.dot(f[1] * z), z.dot(f[2] * z)};
}

Integrals Quadrature::over(Oscillation o, double duration) const {
    Integrals sum = Integrals::Zero();
    for (; duration > flow_.reach(); duration -= flow_.reach()) {
        sum += over_grid(o, Flow::cells);
        o = flow_.at(o, Flow::cells);
    }
    const int cells = static_cast<int>(duration / flow_.cell());
    sum += over_grid(o, cells);
    return sum += over_part(flow_.at(o, cells), std::max(0.0, duration - cells * flow_.cell()));
}

}  // namespace vines
