#include "core/motion/flow.hpp"

#include <algorithm>
#include <cassert>
#include <numbers>

namespace vines {

namespace {

// Keeps rule 1 of contact_search.hpp sharp: its margin M2 h^2/8 is 0.3 % of the amplitude.
constexpr double cells_per_period = 42;

// Taylor terms of the flow over a cell; the first omitted one is below 1e-49.
constexpr int cell_terms = 26;

// Extended precision makes the tables accurate to the last ulp of double.
using Real = long double;

/// x, x' and the phasor.
struct RealState {
    Real x, x_dot, sin, cos;
};

constexpr RealState unit_states[] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}};

/// The states that grow from the four unit states. The first two keep a phasor of zero, and the
/// phasors of the others are one rotation: most entries of the 4x4 matrix are known.
struct FundamentalMatrix {
    std::array<std::array<Real, 2>, 4> motion = {{{1, 0}, {0, 1}, {0, 0}, {0, 0}}};  // x, x'
    Real cos = 1, sin = 0;
};

/// The next Taylor coefficient of the state, the n-th, from the previous one.
RealState next_term(const Flow::Coefficients& c, const RealState& t, int n) {
    const Real stiffness = c[0], damping = c[1], forcing = c[2], Omega = c[3];
    const bool is_forced = t.sin != 0 || t.cos != 0;
    return {
        t.x_dot / n, (-stiffness * t.x - damping * t.x_dot + forcing * t.sin) / n,
        is_forced ? Omega * t.cos / n : 0, is_forced ? -Omega * t.sin / n : 0};
}

/// The state after one cell; sets the Taylor coefficients of its x.
RealState over_cell(
    const Flow::Coefficients& c, const RealState& start, double cell, Flow::TaylorSeries& series) {
    RealState term = start, sum = start;
    Real power = 1;
    series(0) = (double)term.x;
    for (int n = 1; n <= cell_terms; ++n) {
        term = next_term(c, term, n);
        power *= cell;
        sum = {
            sum.x + term.x * power, sum.x_dot + term.x_dot * power, sum.sin + term.sin * power,
            sum.cos + term.cos * power};
        if (n <= Flow::degree) series(n) = (double)term.x;
    }
    return sum;
}

FundamentalMatrix advanced(const FundamentalMatrix& g, const FundamentalMatrix& cell) {
    FundamentalMatrix next;
    const auto unforced = [&](std::size_t j, std::size_t r) {
        return cell.motion[0][r] * g.motion[j][0] + cell.motion[1][r] * g.motion[j][1];
    };
    for (std::size_t r = 0; r < 2; ++r) {
        next.motion[0][r] = unforced(0, r);
        next.motion[1][r] = unforced(1, r);
        next.motion[2][r] = unforced(2, r) + cell.motion[2][r] * g.cos - cell.motion[3][r] * g.sin;
        next.motion[3][r] = unforced(3, r) + cell.motion[2][r] * g.sin + cell.motion[3][r] * g.cos;
    }
    next.cos = cell.cos * g.cos - cell.sin * g.sin;
    next.sin = cell.cos * g.sin + cell.sin * g.cos;
    return next;
}

}  // namespace

Flow::Flow(double stiffness, double damping, double forcing, double Omega)
    : stiffness_(stiffness),
      damping_(damping),
      forcing_(forcing),
      Omega_(Omega),
      cell_(2 * std::numbers::pi / cells_per_period / std::max({1.0, Omega, damping})),
      inverse_root_stiffness_(1 / std::sqrt(stiffness)),
      fastest_decay_(
          0.5 * damping + std::sqrt(std::max(0.0, 0.25 * damping * damping - stiffness))) {
    Response* const parts[4] = {&of_x_, &of_x_dot_, &of_sin_, &of_cos_};
    FundamentalMatrix cell, growth;
    for (std::size_t j = 0; j < 4; ++j) {
        const RealState s = over_cell(coefficients(), unit_states[j], cell_, parts[j]->series);
        cell.motion[j] = {s.x, s.x_dot};
        if (j == 3) cell.cos = s.cos, cell.sin = s.sin;
    }
    for (Response* part : parts) {
        part->near.x = part->series.head<2 * short_pairs>();
        for (int n = 0; n < 2 * short_pairs; ++n)
            part->near.x_dot[n] = (n + 1) * part->series[n + 1];
    }
    for (std::size_t k = 0; k < columns; ++k, growth = advanced(growth, cell)) {
        Row row;
        for (std::size_t j = 0; j < 4; ++j)
            row.x[j] = (double)growth.motion[j][0], row.x_dot[j] = (double)growth.motion[j][1];
        row.cos = (double)growth.cos, row.sin = (double)growth.sin;
        const double time = static_cast<double>(k) * cell_;
        grid.set(k, time, row.x);
        if (k > 0 && k % block == 0) block_ends.set(k / block - 1, time, row.x);
        if (k <= cells) rows_[k] = row;
    }
}

// x'' + 2 zeta x' + x = epsilon A sin(theta), eq. (2).
Flow::Coefficients Flow::free_coefficients(const Parameters& p) {
    return {1, 2 * p.zeta(), p.epsilon * p.A(), p.Omega};
}

namespace {

// Sticking: one body of mass 1 + epsilon, on which the same force acts.
Flow::Coefficients sticking_coefficients(const Parameters& p) {
    const double mass = 1 + p.epsilon;
    return {1 / mass, 2 * p.zeta() / mass, p.epsilon * p.A() / mass, p.Omega};
}

std::shared_ptr<const Flow> shared(const Flow::Coefficients& c) {
    thread_local SmallCache<Flow::Coefficients, Flow> flows;
    return flows.get(c, [&c] { return Flow(c[0], c[1], c[2], c[3]); });
}

/// One Newton step keeps the phasor's length at 1 over millions of rotations.
void keep_length(Oscillation& o) {
    const double shrink = 1.5 - 0.5 * (o.sin_theta * o.sin_theta + o.cos_theta * o.cos_theta);
    o.sin_theta *= shrink;
    o.cos_theta *= shrink;
}

}  // namespace

std::shared_ptr<const Flow> Flow::shared_free(const Parameters& p) {
    return shared(free_coefficients(p));
}
std::shared_ptr<const Flow> Flow::shared_sticking(const Parameters& p) {
    return shared(sticking_coefficients(p));
}

Oscillation Flow::at(const Oscillation& o, int k) const {
    assert(k >= 0 && k <= cells);
    Oscillation next = roughly_at(o, k);
    keep_length(next);
    return next;
}

Oscillation Flow::rotated(const Oscillation& o, double d) const {
    // cos and sin of 0 <= a <= 2 pi/42 by their series; the first omitted terms are below 1e-18.
    const double a = Omega_ * d, q = a * a;
    const double cos =
        1 + q * (-1.0 / 2 +
                 q * (1.0 / 24 + q * (-1.0 / 720 + q * (1.0 / 40320 + q * (-1.0 / 3628800)))));
    const double sin =
        a *
        (1 + q * (-1.0 / 6 + q * (1.0 / 120 +
                                  q * (-1.0 / 5040 + q * (1.0 / 362880 + q * (-1.0 / 39916800))))));
    Oscillation next = {
        o.x, o.x_dot, o.sin_theta * cos + o.cos_theta * sin, o.cos_theta * cos - o.sin_theta * sin};
    keep_length(next);
    return next;
}

SeriesValue value_at(const Flow::TaylorSeries& c, double d) {
    // Even and odd coefficients separately: two short dependency chains instead of a long one.
    static_assert(Flow::degree % 2 == 1);
    const double q = d * d;
    constexpr int n = Flow::degree;
    double x[2] = {c[n - 1], c[n]}, v[2] = {n * c[n], (n - 1) * c[n - 1]},
           a[2] = {0, 0.5 * (n * (n - 1)) * c[n]};
    for (int k = n - 3; k >= 0; k -= 2) {
        x[0] = x[0] * q + c[k];
        x[1] = x[1] * q + c[k + 1];
        v[0] = v[0] * q + (k + 1) * c[k + 1];
        a[0] = a[0] * q + 0.5 * ((k + 2) * (k + 1)) * c[k + 2];
        if (k > 0) {
            v[1] = v[1] * q + k * c[k];
            a[1] = a[1] * q + 0.5 * ((k + 1) * k) * c[k + 1];
        }
    }
    return {x[0] + d * x[1], v[0] + d * v[1], a[0] + d * a[1]};
}

Oscillation Flow::along(const TaylorSeries& c, const Oscillation& o, double d) const {
    Oscillation next = rotated(o, d);
    const SeriesValue value = value_at(c, d);
    next.x = value.x;
    next.x_dot = value.x_dot;
    return next;
}

Oscillation Flow::after(Oscillation o, double s) const {
    assert(s >= 0);
    for (; s >= reach(); s -= reach()) o = at(o, cells);
    const int k = static_cast<int>(s / cell_);
    o = at(o, k);
    const double d = std::max(0.0, s - k * cell_);
    Oscillation next = rotated(o, d);
    const auto [x, x_dot] = short_series(o).at(d);
    next.x = x, next.x_dot = x_dot;
    return next;
}

// Block (x', x) of J, eq. (19).
Transfer Flow::transfer(double s) const {
    assert(s >= 0);
    const auto after = [](const Transfer& t, const Transfer& j) -> Transfer {
        return {
            t.a11 * j.a11 + t.a12 * j.a21, t.a11 * j.a12 + t.a12 * j.a22,
            t.a21 * j.a11 + t.a22 * j.a21, t.a21 * j.a12 + t.a22 * j.a22};
    };
    const auto row = [this](int k) -> Transfer {
        const Row& r = rows_[static_cast<std::size_t>(k)];
        return {r.x_dot[1], r.x_dot[0], r.x[1], r.x[0]};
    };
    long reaches = 0;
    for (; s >= reach(); s -= reach()) ++reaches;
    const int k = static_cast<int>(s / cell_);
    const double d = std::max(0.0, s - k * cell_);
    // In a cell: if u is the motion from (x', x) = (1, 0), u' + damping u is that from (0, 1).
    const auto [u, u_dot] = of_x_dot_.near.at(d);
    Transfer j = after({u_dot, -stiffness_ * u, u, u_dot + damping_ * u}, row(k));
    for (; reaches > 0; --reaches) j = after(j, row(cells));
    return j;
}

}  // namespace vines
