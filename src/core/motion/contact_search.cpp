#include "core/motion/contact_search.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

namespace vines {

namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();

// A step below 1e-6 of the root is the last: the next one would be below 1e-18.
constexpr double last_step = 1e-6;
// Last step in a cell, relative to h: the Taylor polynomial of second order suffices for it.
constexpr double last_step_in_cell = 1e-7;

/// Bisection on a polynomial, with a bound of its third derivative on [0, h].
struct CrossingSearch {
    std::span<const double> c;
    double h, noise;
    std::optional<double>& tangent;
    double third = 0;

    std::optional<double> search() {
        double power = 1;
        for (std::size_t n = 3; n < c.size(); ++n, power *= h)
            third += n * (n - 1.0) * (n - 2.0) * std::abs(c[n]) * power;
        return in(0, h);
    }

    struct Value {
        double f, f1, f2;  // value, first derivative, half of the second
    };

    Value at(double d) const {
        Value v{0, 0, 0};
        for (std::size_t n = c.size(); n-- > 0;) {
            v.f2 = v.f2 * d + v.f1;
            v.f1 = v.f1 * d + v.f;
            v.f = v.f * d + c[n];
        }
        return v;
    }

    /// First upward crossing in (a, e], given that the polynomial is negative at a.
    std::optional<double> in(double a, double e) {
        const double middle = 0.5 * (a + e), radius = 0.5 * (e - a);
        const Value m = at(middle);
        if (m.f + radius * (std::abs(m.f1) + radius * (std::abs(m.f2) + radius * third / 6)) <
            -noise)
            return {};

        const bool monotone = std::abs(m.f1) > radius * (2 * std::abs(m.f2) + radius * third / 2);
        const bool one_curvature = 2 * std::abs(m.f2) > radius * third;
        const bool at_resolution = middle <= a || middle >= e || radius < ulp * h;
        if (monotone || one_curvature || at_resolution) {
            const Value end = at(e);
            if (!at_resolution && !monotone && m.f2 < 0 && end.f1 < 0) return before_maximum(a, e);
            if (end.f < 0) return {};
            if (at_resolution) return e;
            return m.f < 0 ? root(middle, m.f, e, end.f) : root(a, at(a).f, middle, m.f);
        }
        if (auto d = in(a, middle)) return d;
        return in(middle, e);
    }

    /// The concave case: the only candidate is the rise towards a maximum in (a, e).
    std::optional<double> before_maximum(double a, double e) {
        if (at(a).f1 <= 0) return {};
        double low = a, high = e, d = 0.5 * (a + e);  // f1 > 0 at low, < 0 at high
        for (int i = 0; i < 100 && high - low > 2 * ulp * e; ++i) {
            const Value v = at(d);
            (v.f1 > 0 ? low : high) = d;
            const double newton = d - v.f1 / (2 * v.f2);
            if (newton == d) break;
            d = newton > low && newton < high ? newton : 0.5 * (low + high);
        }
        const double top = at(d).f;
        if (top >= 0) return root(a, at(a).f, d, top);
        if (top >= -noise) tangent = d;
        return {};
    }

    /// The only upward crossing in (a, e], f(a) = fa < 0 <= f(e) = fe: Halley steps inside the
    /// bracket. Where rounding prevents convergence, the bracket is halved until it is an ulp wide.
    double root(double a, double fa, double e, double fe) const {
        double low = a, high = e;
        double d = fe > fa ? a - fa * (e - a) / (fe - fa) : 0.5 * (a + e);
        for (int i = 0; high - low > ulp * d; ++i) {
            const Value v = at(d);
            if (v.f == 0) return d;
            (v.f < 0 ? low : high) = d;
            const double step = halley(v.f, v.f1, v.f2);
            if (std::abs(step) <= last_step * d && v.f1 > 0 &&
                std::abs(step * v.f2) <= last_step * v.f1)
                return std::clamp(d + step, low, high);
            d = i < 20 && d + step > low && d + step < high ? d + step : 0.5 * (low + high);
            if (d <= low || d >= high) break;  // neighbours
        }
        return d;
    }
};

}  // namespace

std::optional<double> first_crossing(
    std::span<const double> c, int zeros, double h, double noise, std::optional<double>& tangent) {
    c = c.subspan(zeros);
    if (zeros > 0)
        while (!c.empty() && c[0] == 0) c = c.subspan(1);
    // Identically zero.
    if (std::all_of(c.begin(), c.end(), [](double v) { return v == 0; })) return {};
    if (c[0] >= 0) return 0;
    return CrossingSearch{c, h, zeros > 0 ? 0 : noise, tangent}.search();
}

namespace {

/// The part of a cell in which to search up to a time `left`. Far beyond it the Taylor polynomial
/// of a load much faster than a cell grows without bound.
double searched(double h, double left) { return left < 0.125 * h ? left : h; }

/// CellSearch for a contact in a single cell of one flight.
struct CellSearch {
    const Flow& flow;
    const FlightStart& start;
    double b, limit;
    double h;
    double eta;           // rounding of g on the grid
    double M2;            // >= |g''|
    const Polynomial& y;  // the ball's path
    std::vector<GrazingPoint>& grazing;

    /// The most common case of rule 4: g is monotone in cell k and ends at or beyond the wall
    /// ahead.
    std::optional<Contact> straight(int k, const Oscillation& lo, double next_relative) const {
        const Polynomial y_left = y.about(k * h);
        const double speed = lo.x_dot - y_left[1];
        if (std::abs(speed) <= M2 * h) return {};
        const int wall = speed > 0 ? 1 : -1;
        const double f0 = wall * (lo.x - y_left[0]) - b, fh = wall * next_relative - b;
        if (f0 >= 0 || fh < -eta) return {};

        // f = wall g - b in the cell: the quartic about the left end plus a fifth term so that it
        // matches f(h). One Halley step from the root of the chord leaves an error below 1e-6 h, a
        // second one, on the full series, below an ulp.
        const Flow::TaylorSeries c = flow.series(lo);
        const double f1 = wall * speed, f2 = wall * (c[2] - y_left[2]),
                     f3 = wall * (c[3] - y_left[3]), f4 = wall * (c[4] - y_left[4]);
        const double inverse_h = 1 / h;
        const double f5 = ((((fh - f0) * inverse_h - f1) * inverse_h - f2) * inverse_h - f3) *
                              inverse_h * inverse_h -
                          f4 * inverse_h;
        double d = -f0 * h / (fh - f0);
        d += halley(
            f0 + d * (f1 + d * (f2 + d * (f3 + d * (f4 + d * f5)))),
            f1 + d * (2 * f2 + d * (3 * f3 + d * (4 * f4 + d * 5 * f5))),
            f2 + d * (3 * f3 + d * (6 * f4 + d * 10 * f5)));
        d = std::clamp(d, 0.0, h);

        // Two steps suffice unless the flight is so slow that in_cell() has to bracket the root.
        SeriesValue v;
        double step;
        for (int i = 0;; ++i) {
            if (i == 8) return {};
            v = value_at(c, d);
            step = halley(
                wall * (v.x - y_left.at(d)) - b, wall * (v.x_dot - y_left.rate(d)),
                wall * (v.half_x_ddot - 0.5 * y_left.second(d)));
            if (std::abs(step) <= last_step_in_cell * h) break;
            d = std::clamp(d + step, 0.0, h);
        }
        // The last tiny step by the Taylor polynomial of the state; the remainder is below 1e-18.
        d += step;
        Oscillation at = flow.rotated(lo, d);
        at.x = v.x + step * (v.x_dot + step * v.half_x_ddot);
        at.x_dot = v.x_dot + step * 2 * v.half_x_ddot;
        return Contact{k * h + d, wall, at, at.x_dot - y_left.rate(d)};
    }

    /// The next contact of a chatter. The flight left its wall with relative speed -w, and a = side
    /// x'' > 0 presses it back. f = side g - b is s phi(s) with phi(0) = -w, phi'(0) = a/2 and
    /// |phi''| <= M3/3. Let D = 4 w/a. If M3 D < a, phi rises on [0, D] (phi' >= a/2 - M3 D/3 > 0)
    /// and phi(D) >= -w + a D/2 - M3 D^2/6 > w - a D/6 > 0: exactly one contact lies in (0, D], and
    /// it is the first if the other wall is out of reach.
    std::optional<Contact> chatter(double M3) const {
        const double w = -start.side * start.relative_speed,
                     a = start.side * (flow.acceleration(start.lo) - 2 * y[2]);
        if (!(start.zeros == 1 && a > 0 && 4 * w <= a * h)) return {};
        const double D = 4 * w / a;
        if (M3 * D >= a || D * (w + M2 * D) >= b) return {};
        const Flow::TaylorSeries x = flow.series(start.lo);
        Flow::TaylorSeries phi;
        phi[0] = -w;
        for (int n = 1; n < Flow::degree; ++n) phi[n] = start.side * (x[n + 1] - y[n + 1]);
        phi[Flow::degree] = 0;
        double d = 2 * w / a, rate = 0;
        for (int i = 0; i < 50; ++i) {
            const SeriesValue v = value_at(phi, d);
            const double step = halley(v.x, v.x_dot, v.half_x_ddot);
            d = std::clamp(d + step, 0.5 * w / a, D);
            rate = v.x_dot + step * 2 * v.half_x_ddot;
            if (std::abs(step) <= last_chatter_step * d) break;
        }
        // f' = phi + s phi'.
        return Contact{d, start.side, flow.along(x, start.lo, d), start.side * d * rate};
    }

    /// Rule 1 for one wall, with wall g at the ends of the cell.
    bool beneath(double left, double right, double bound) const {
        return std::max(left, right) < b - bound * h * h / 8 - eta;
    }

    /// The contact in cell k, if any: rules 3 and 4. left, right: g at the ends of the cell.
    std::optional<Contact> in_cell(int k, const Oscillation& lo, double left, double right) const {
        const bool first = k == 0 && start.side != 0;
        const Flow::TaylorSeries x = flow.series(lo);
        const Polynomial y_left = y.about(k * h);
        Flow::TaylorSeries g = x;  // x - y
        for (int n = 2; n < y_left.size; ++n) g[n] -= y_left[n];
        std::optional<Contact> found;
        for (int wall : {1, -1}) {
            if (beneath(wall * left, wall * right, M2)) continue;
            Flow::TaylorSeries f = wall * g;  // wall (x - y) - b, negative inside the cavity
            f[0] = first && wall != start.side ? -2 * b : wall * (lo.x - y_left[0]) - b;
            f[1] = first ? wall * start.relative_speed : wall * (lo.x_dot - y_left[1]);
            const int zeros = first && wall == start.side ? start.zeros : 0;
            std::optional<double> tangent;
            const auto d = first_crossing(
                {f.data(), static_cast<std::size_t>(f.size())}, zeros, searched(h, limit - k * h),
                eta, tangent);
            if (tangent && k * h + *tangent <= limit) grazing.push_back({k * h + *tangent, wall});
            if (!d || (found && found->s <= k * h + *d)) continue;
            for (int n = 0; n < zeros; ++n) f[n] = 0;
            found = Contact{
                k * h + *d, wall, flow.along(x, lo, *d),
                wall * std::max(0.0, value_at(f, *d).x_dot)};
        }
        return found;
    }

    /// True if rules 1 and 2 prove the first cell of a flight from a wall empty.
    bool first_cell_empty(double next_relative, double M3) const {
        const double leaving = -M3 * h * h / 24 - eta / h;
        return start.zeros == 1 && start.side * start.relative_speed < leaving &&
               (start.side * next_relative - b) / h < leaving &&
               -start.side * next_relative < b - M2 * h * h / 8 - eta;
    }
};

}  // namespace

// Five products and five sums, twice (in the table, too), and a safety factor of three.
constexpr double grid_rounding = 16 * 0x1p-52;

double position_rounding(const Flow::Bounds& bounds, double y, double b) {
    return grid_rounding * (bounds.x + b + std::abs(y));
}

std::optional<Contact> next_contact(
    const Flow& flow, const FlightStart& start, double b, double limit,
    std::vector<GrazingPoint>& grazing) {
    assert(limit <= flow.reach() && b > 0);
    assert(start.side == 0 || (start.zeros >= 1 && start.zeros <= 3));
    const auto bounds = flow.bounds(start.lo);
    const Polynomial y = start.ball();
    const double h = flow.cell(), T = std::min(flow.reach(), limit + Flow::block * h),
                 y_2 = y.bound(2, T),
                 eta = position_rounding(bounds, std::abs(y[0]) + T * T * y_2, b),
                 M2 = bounds.x_ddot + y_2, M3 = bounds.x_dddot + y.bound(3, T);
    const CellSearch search{flow, start, b, limit, h, eta, M2, y, grazing};
    const double inside = b - M2 * h * h / 8 - eta;  // rule 1

    double relative = start.side != 0 ? start.side * b : start.lo.x - start.y;
    for (int from = 0; from < Flow::cells && from * h < limit; from += Flow::block) {
        const Flow::Block next = flow.relative_positions(start.lo, y, from + 1);
        if (std::abs(relative) < inside &&
            next.abs().maxCoeff() < inside) {  // the complete block is empty
            relative = next[Flow::block - 1];
            continue;
        }
        for (int i = 0; i < Flow::block && (from + i) * h < limit; relative = next[i++]) {
            const int k = from + i;
            const bool leaving = k == 0 && start.side != 0;
            if (leaving ? search.first_cell_empty(next[i], M3)
                        : std::abs(relative) < inside && std::abs(next[i]) < inside)
                continue;
            const Oscillation lo = k == 0 ? start.lo : flow.at(start.lo, k);
            const double own_M2 = std::abs(flow.acceleration(lo) - y.second(k * h)) + M3 * h;
            if (!leaving && search.beneath(std::abs(relative), std::abs(next[i]), own_M2)) continue;
            std::optional<Contact> contact =
                leaving ? search.chatter(M3) : search.straight(k, lo, next[i]);
            if (!contact) contact = search.in_cell(k, lo, relative, next[i]);
            if (contact) return contact->s <= limit ? contact : std::nullopt;
        }
    }
    return {};
}

namespace {

/// The first s in (0, limit] at which a positive function falls to zero. value(k): the function at
/// the left end of cell k; it changes by at most `rate` per unit of time. falling(k): coefficients
/// of the negative function about that end. `zeros` derivatives vanish at s = 0, counting the 0th.
template <class Value, class Coefficients>
std::optional<double> first_zero(
    const Flow& flow, int zeros, double limit, double rate, const Value& value,
    const Coefficients& falling) {
    assert(limit <= flow.reach());
    const double h = flow.cell();
    for (int k = 0, positive = 0; k < Flow::cells && k * h < limit; k += std::max(1, positive)) {
        const int vanishing = k == 0 ? zeros : 0;
        // Cells over which the function certainly stays positive.
        const double cells = vanishing > 0 ? 0 : std::ceil(value(k) / (rate * h)) - 1;
        positive = cells > 0 ? static_cast<int>(std::min<double>(cells, Flow::cells)) : 0;
        if (positive > 0) continue;
        std::optional<double> tangent;
        const double end = searched(h, limit - k * h);
        if (const auto d = first_crossing(falling(k), vanishing, end, 0, tangent))
            return k * h + *d <= limit ? std::optional(k * h + *d) : std::nullopt;
    }
    return {};
}

}  // namespace

std::optional<double> next_release(
    const Flow& flow, const Oscillation& start, int side, int zeros, double limit,
    const Polynomial& pull, double least) {
    assert(side != 0 && (zeros == 0 || zeros == 1));
    const double h = flow.cell(), time = std::min(flow.reach(), limit + h),
                 M3 = flow.bounds(start, time).x_dddot + pull.bound(1, time);
    const auto at = [&](int k) { return k == 0 ? start : flow.at(start, k); };
    // side (x'' - pull) - least is positive while the ball is held.
    const auto held = [&](int k) {
        return side * (flow.acceleration(at(k)) - pull.at(k * h)) - least;
    };
    const auto falling = [&](int k) {
        const Flow::TaylorSeries x = flow.series(at(k));
        const Polynomial pulls = pull.about(k * h);
        std::array<double, Flow::degree - 1> f;
        for (int n = 0; n + 2 <= Flow::degree; ++n) f[n] = -side * (n + 1.0) * (n + 2.0) * x[n + 2];
        f[0] += least;
        for (int n = 0; n < pull.size; ++n) f[static_cast<std::size_t>(n)] += side * pulls[n];
        return f;
    };
    return first_zero(flow, zeros, limit, M3, held, falling);
}

std::optional<double> next_equal_velocity(
    const Flow& flow, const FlightStart& start, int direction, int zeros, double limit) {
    assert(direction != 0);
    const Polynomial y = start.ball();
    const double h = flow.cell(), time = std::min(flow.reach(), limit + h),
                 M2 = flow.bounds(start.lo, time).x_ddot + y.bound(2, time);
    const auto speed = [&](int k) {
        return direction * (k > 0             ? flow.speed_at(start.lo, k) - y.rate(k * h)
                            : start.side != 0 ? start.relative_speed
                                              : start.lo.x_dot - y[1]);
    };
    const auto falling = [&](int k) {
        const Flow::TaylorSeries x = flow.series(k == 0 ? start.lo : flow.at(start.lo, k));
        const Polynomial y_left = y.about(k * h);
        std::array<double, Flow::degree> f;
        for (int n = 0; n < Flow::degree; ++n) f[n] = -direction * (n + 1.0) * x[n + 1];
        for (int n = 1; n < y.size; ++n)
            f[static_cast<std::size_t>(n) - 1] += direction * n * y_left[n];
        if (k == 0) f[0] = -speed(0);
        return f;
    };
    return first_zero(flow, zeros, limit, M2, speed, falling);
}

}  // namespace vines
