#include "core/guard.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vines {

namespace {

constexpr double ulp = std::numeric_limits<double>::epsilon();

/// A polynomial with its bound of the third derivative on [0, h].
class CrossingSearch {
public:
    CrossingSearch(std::span<const double> c, double h, double noise, std::optional<double>& tangent)
        : c_(c), h_(h), noise_(noise), tangent_(tangent) {
        double power = 1;
        for (std::size_t n = 3; n < c.size(); ++n, power *= h)
            third_ += n * (n - 1.0) * (n - 2.0) * std::abs(c[n]) * power;
    }

    std::optional<double> search() { return in(0, h_); }

private:
    struct Value {
        double f, f1, f2;  // value, first derivative, half the second
    };

    Value at(double d) const {
        Value v{0, 0, 0};
        for (std::size_t n = c_.size(); n-- > 0;) {
            v.f2 = v.f2 * d + v.f1;
            v.f1 = v.f1 * d + v.f;
            v.f = v.f * d + c_[n];
        }
        return v;
    }

    /// First upward crossing in (a, e], given that the polynomial is negative at a.
    std::optional<double> in(double a, double e) {
        const double middle = 0.5 * (a + e), radius = 0.5 * (e - a);
        const Value m = at(middle);
        if (m.f + radius * (std::abs(m.f1) + radius * (std::abs(m.f2) + radius * third_ / 6)) < -noise_) return {};

        const bool monotone = std::abs(m.f1) > radius * (2 * std::abs(m.f2) + radius * third_ / 2);
        const bool one_curvature = 2 * std::abs(m.f2) > radius * third_;
        const bool at_resolution = middle <= a || middle >= e || radius < ulp * h_;
        if (monotone || one_curvature || at_resolution) {
            const Value end = at(e);
            if (!at_resolution && !monotone && m.f2 < 0 && end.f1 < 0) return before_maximum(a, e);
            if (end.f < 0) return {};
            return at_resolution ? e : root(a, e);
        }
        if (auto d = in(a, middle)) return d;
        return in(middle, e);
    }

    /// The concave case: the only candidate is the rise towards the maximum, if that lies in (a, e).
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
        if (top >= 0) return root(a, d);
        if (top >= -noise_) tangent_ = d;
        return {};
    }

    /// The only upward crossing in (a, e], f(a) < 0 <= f(e): Halley's steps kept inside the bracket.
    double root(double a, double e) const {
        double low = a, high = e;
        const double fa = at(a).f, fe = at(e).f;
        double d = fe > fa ? a - fa * (e - a) / (fe - fa) : 0.5 * (a + e);
        for (int i = 0; i < 200; ++i) {
            const Value v = at(d);
            if (v.f == 0) return d;
            (v.f < 0 ? low : high) = d;
            const double denominator = v.f1 * v.f1 - v.f * v.f2;
            double next = d - v.f * v.f1 / denominator;
            if (!(next > low && next < high)) next = 0.5 * (low + high);
            const double change = std::abs(next - d);
            d = next;
            // Halley's error shrinks with the cube of the step: after one below 1e-6 of d the next is below an ulp.
            if (change <= 1e-6 * d && v.f1 > 0 && change * std::abs(v.f2) <= 1e-6 * v.f1) break;
            if (high - low <= ulp * d) break;
        }
        return d;
    }

    std::span<const double> c_;
    double h_, noise_, third_ = 0;
    std::optional<double>& tangent_;
};

}  // namespace

std::optional<double> first_crossing(std::span<const double> c, int zeros, double h, double noise, std::optional<double>& tangent) {
    c = c.subspan(zeros);
    if (zeros > 0)
        while (!c.empty() && c[0] == 0) c = c.subspan(1);
    if (c.empty()) return {};
    if (c[0] >= 0) return 0;
    return CrossingSearch(c, h, zeros > 0 ? 0 : noise, tangent).search();
}

std::optional<Contact> next_contact(const Flow& flow, const FlightStart& start, double b, double limit, std::optional<Touch>& touch) {
    const double h = flow.cell();
    const auto bounds = flow.bounds(start.lo);
    const double eta = 16 * ulp * (bounds.x + b + std::abs(start.y));                      // rounding of g on the grid
    const double inside = b - bounds.x_ddot * h * h / 8 - eta;                             // property 1
    const double leaving = -bounds.x_dddot * h * h / 24 - eta / h;                         // property 2
    const int side = start.side;
    auto gap_at = [&](int k) { return flow.x_at(start.lo, k) - start.y - start.y_dot * (k * h); };

    // The contact in cell k, if there is one: property 3.
    auto search = [&](int k) -> std::optional<Contact> {
        const bool first = k == 0 && side != 0;
        const Oscillation lo = k == 0 ? start.lo : flow.at(start.lo, k);
        const Flow::Series x = flow.series(lo);
        std::optional<Contact> found;
        for (int wall : {1, -1}) {
            Flow::Series f;  // wall (x - y) - b, which is negative inside the cavity
            for (std::size_t n = 0; n < f.size(); ++n) f[n] = wall * x[n];
            f[0] = first && wall != side ? -2 * b : wall * (lo.x - start.y - start.y_dot * (k * h)) - b;
            f[1] = first ? wall * start.relative_speed : wall * (lo.x_dot - start.y_dot);
            std::optional<double> tangent;
            const auto d = first_crossing(f, first && wall == side ? start.zeros : 0, h, eta, tangent);
            if (tangent && k * h + *tangent <= limit) touch = Touch{k * h + *tangent, wall};
            if (!d || (found && found->s <= k * h + *d)) continue;
            double speed = 0;
            for (int n = Flow::degree; n >= 1; --n) {
                const bool known_zero = first && wall == side && n < start.zeros;
                speed = speed * *d + (known_zero ? 0 : n * f[n]);
            }
            found = Contact{k * h + *d, wall, flow.along(x, lo, *d), wall * std::max(0.0, speed)};
        }
        return found;
    };

    double gap = side != 0 ? side * b : gap_at(0);
    for (int k = 0; k < Flow::cells && k * h < limit; ++k) {
        const double next_gap = gap_at(k + 1);
        bool empty;
        if (k == 0 && side != 0)
            empty = start.zeros == 1 && side * start.relative_speed < leaving && (side * next_gap - b) / h < leaving &&
                    -side * next_gap < inside;
        else
            empty = std::abs(gap) < inside && std::abs(next_gap) < inside;
        if (!empty)
            if (auto contact = search(k)) return contact->s <= limit ? contact : std::nullopt;
        gap = next_gap;
    }
    return {};
}

std::optional<double> next_release(const Flow& flow, const Oscillation& start, int side, int zeros, double limit) {
    const double h = flow.cell();
    for (int k = 0; k < Flow::cells && k * h < limit; ++k) {
        const Flow::Series x = flow.series(k == 0 ? start : flow.at(start, k));
        std::array<double, Flow::degree - 1> f;  // -side x'', which is negative while the wall presses
        for (int n = 0; n + 2 <= Flow::degree; ++n) f[n] = -side * (n + 1.0) * (n + 2.0) * x[n + 2];
        std::optional<double> tangent;
        if (auto d = first_crossing(f, k == 0 ? zeros : 0, h, 0, tangent))
            return k * h + *d <= limit ? std::optional(k * h + *d) : std::nullopt;
    }
    return {};
}

}  // namespace vines
