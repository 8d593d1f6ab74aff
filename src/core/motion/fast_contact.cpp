#include "core/motion/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace vines {

namespace {

// Last Halley step, relative to a cell: the state is carried over it by its Taylor polynomial of
// second order, and the curvature leaves an error of (1.5e-7)^2 5e-4 = 1e-17.
constexpr double little_step = 1e-6;
// Maximum number of steps to find a crossing; after that next_contact() takes over.
constexpr int most_crossing_steps = 4;

// Reach of near_series(), over a cell, and its coefficients.
constexpr double near_reach = 1.0 / 20;
constexpr int near_size = 8;
constexpr double inverse_factorial[near_size] = {1,        1,         1.0 / 2,   1.0 / 6,
                                                 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040};

/// Flow::short_series() for |d| <= near_reach h, from the derivatives, to 1e-20 of the motion.
Flow::ShortSeries near_series(const Flow& flow, const Oscillation& o) {
    const auto [stiffness, damping, forcing, Omega] = flow.coefficients();
    Flow::ShortSeries s{Flow::ShortCoefficients::Zero(), Flow::ShortCoefficients::Zero()};
    double before = o.x, derivative = o.x_dot, sin = o.sin_theta, cos = o.cos_theta;
    s.x[0] = o.x, s.x[1] = s.x_dot[0] = o.x_dot;
    for (int n = 2; n < near_size; ++n) {
        const double next = forcing * sin - stiffness * before - damping * derivative;
        s.x_dot[n - 1] = next * inverse_factorial[n - 1];
        s.x[n] = next * inverse_factorial[n];
        before = derivative, derivative = next;
        const double sin_rate = Omega * cos;
        cos = -Omega * sin, sin = sin_rate;
    }
    return s;
}

/// True for a ball under no or a constant force, between the walls, leaving one or released.
bool is_simple(const FlightStart& start) {
    return !start.shift && (start.side == 0 || start.zeros == 3 ||
                            (start.zeros == 1 && start.side * start.relative_speed < 0));
}

enum class SearchResult { contact, none, undecided };

/// One flight, under a constant force if it `bends`. All positions are mirrored if it leaves the
/// wall at x - y = -b, so that a flight from a wall always leaves x - y = b.
template <bool bends>
struct FastSearch {
    const Flow& flow;
    const FlightStart& start;
    double b, limit;
    bool leaves_wall = start.side != 0, is_released = start.zeros == 3;
    double mirror = leaves_wall ? start.side : 1;
    double w = -mirror * start.relative_speed;  // away from the wall
    double y = mirror * start.y, y_dot = mirror * start.y_dot, y_2 = mirror * start.y_2;
    Oscillation lo = mirrored(start.lo);
    double h = flow.cell();
    Flow::Bounds bounds = flow.bounds(lo);
    double M2 = bounds.x_ddot + 2 * std::abs(y_2), M3 = bounds.x_dddot;
    double eta = position_rounding(bounds, std::abs(y) + limit * limit * std::abs(y_2), b);

    // A straight flight takes the shorter terms: the search is the most frequent step of a run.
    double y_dot_at(double s) const {
        if constexpr (bends) return y_dot + 2 * y_2 * s;
        return y_dot;
    }
    double relative_acceleration(const Oscillation& o) const {
        if constexpr (bends) return flow.acceleration(o) - 2 * y_2;
        return flow.acceleration(o);
    }
    /// y after s with the velocity `rate` at its start.
    double moved(double from, double rate, double s) const {
        if constexpr (bends) return from + (rate + y_2 * s) * s;
        return from + rate * s;
    }

    Oscillation mirrored(const Oscillation& o) const {
        return {mirror * o.x, mirror * o.x_dot, mirror * o.sin_theta, mirror * o.cos_theta};
    }

    /// Rule 1: no contact between two points this far apart if |x - y| is below this at both.
    double inside(double width) const { return b - M2 * (width * width / 8) - eta; }

    /// Rule 2, and rule 1 for the other wall, over the first interval of this width.
    bool leaves(double right, double width, double inside) const {
        const double least = M3 * (width * width / 24) + eta / width;
        return w > least && b - right > least * width && right > -inside;
    }

    /// Tests blocks of cells, then the cells of each block not proven empty as a whole.
    SearchResult search(std::optional<Contact>& contact) const {
        const double width = Flow::block * h, least = inside(width);
        if (leaves_wall && !is_released) {
            const double a = relative_acceleration(lo);
            if (is_in_chatter(a)) return return_within(4 * w / a, a, contact);
        }
        const int blocks =
            limit < flow.reach() ? static_cast<int>(limit / width) + 1 : Flow::cells / Flow::block;
        double left = leaves_wall ? b : lo.x - y;  // x - y at a block's left end
        bool left_inside = std::abs(left) < least;
        for (int from = 0; from < blocks; from += Flow::block) {
            Flow::Block ends = flow.block_ends.relative_positions(lo, y, y_dot, from);
            if constexpr (bends) ends -= y_2 * flow.block_ends.squared_times(from);
            for (int i = 0; i < Flow::block && from + i < blocks; ++i) {
                const double right = ends[i];
                const bool right_inside = std::abs(right) < least;
                const bool empty = from + i == 0 && leaves_wall ? leaves(right, width, least)
                                                                : left_inside && right_inside;
                if (!empty) {
                    const SearchResult found = search_block(from + i, left, contact);
                    if (found != SearchResult::none) return found;
                }
                left = right;
                left_inside = right_inside;
            }
        }
        return SearchResult::none;
    }

    SearchResult search_block(int block, double left, std::optional<Contact>& contact) const {
        const int from = Flow::block * block;
        Flow::Block ends = flow.grid.relative_positions(lo, y, y_dot, from + 1);
        if constexpr (bends) ends -= y_2 * flow.grid.squared_times(from + 1);
        const double least = inside(h);
        if (from == 0 && !leaves_wall && std::abs(left) >= b - eta) return SearchResult::undecided;
        // A faster flight is soon so far from the wall that rule 1 applies.
        const bool is_slow = leaves_wall && (is_released || w < M2 * (Flow::block * h));
        const double departure = is_slow ? duration_of_departure() : 0;
        for (int i = 0; i < Flow::block; ++i) {
            const int k = from + i;
            const double right = ends[i];
            if ((k + 1) * h <= departure) {
                if (right <= -least) return SearchResult::undecided;
            } else if (k == 0 && leaves_wall) {
                const SearchResult first =
                    leaves(right, h, least) ? SearchResult::none : search_first(right, contact);
                if (first != SearchResult::none) return first;
            } else if (std::abs(right) >= b - eta) {
                return crossing(k, left, right, contact);
            } else if (
                !(std::abs(left) < least && std::abs(right) < least) && !is_empty(k, left, right)) {
                return SearchResult::undecided;
            }
            left = right;
        }
        return SearchResult::none;
    }

    /// Time for which x - y, once it is b, certainly falls: rule 5.
    double duration_of_departure() const {
        if (!is_released) return -2 * relative_acceleration(lo) / M3;
        const auto [stiffness, damping, forcing, Omega] = flow.coefficients();
        const double M4 = stiffness * M2 + damping * M3 + std::abs(forcing) * Omega * Omega;
        return -3 * flow.jerk(lo) / M4;
    }

    /// True if a function with these derivatives at the left end rises throughout a cell.
    bool rises(double first, double second) const {
        return first + std::min(0.0, second * h) > 0.5 * M3 * (h * h);
    }

    /// True if a cell without contacts at its ends has none: by monotony, or by rule 1.
    bool is_empty(int k, double left, double right) const {
        const Oscillation o = flow.roughly_at(lo, k);
        const double rate = o.x_dot - y_dot_at(k * h);
        if (std::abs(rate) > M2 * h) return true;
        const double a = relative_acceleration(o);
        if (rises(rate, a) || rises(-rate, -a)) return true;
        const double wall = left + right > 0 ? 1 : -1, bulge = std::max(0.0, M3 * h - wall * a);
        return std::max(wall * left, wall * right) < b - bulge * (h * h / 8) - eta &&
               std::min(wall * left, wall * right) > -inside(h);
    }

    /// The contact in cell k if x - y is monotone there: the most common case of rule 4. A contact
    /// at the right grid point can be found one rounding error beyond it.
    SearchResult crossing(int k, double left, double right, std::optional<Contact>& contact) const {
        const double wall = right > 0 ? 1 : -1, f0 = wall * left - b, fh = wall * right - b;
        const Oscillation o = flow.roughly_at(lo, k);
        const double jerk = flow.jerk(o), snap = flow.snap(o), rate_left = y_dot_at(k * h);
        const double f1 = wall * (o.x_dot - rate_left), f2 = 0.5 * wall * relative_acceleration(o),
                     f3 = (1.0 / 6) * wall * jerk, f4 = (1.0 / 24) * wall * snap;
        if (!rises(f1, 2 * f2) || f0 >= 0) return SearchResult::undecided;

        // Root of the chord, corrected for curvature; one step on the quartic about the left end,
        // with a fifth term so that it matches f(h), to about 1e-8 h; then a step on the series.
        const double per_h = 1 / h, slope = (fh - f0) * per_h, inverse_slope = 1 / slope;
        const double f5 = ((((slope - f1) * per_h - f2) * per_h - f3) * per_h - f4) * per_h;
        double d = -f0 * inverse_slope;
        d += f2 * d * (h - d) * inverse_slope;
        d += halley(
            f0 + d * (f1 + d * (f2 + d * (f3 + d * (f4 + d * f5)))),
            f1 + d * (2 * f2 + d * (3 * f3 + d * (4 * f4 + d * (5 * f5)))),
            f2 + d * (3 * f3 + d * (6 * f4 + d * (10 * f5))));
        const Flow::ShortSeries series = flow.short_series(o);
        const double y_left = moved(y, y_dot, k * h);
        for (int i = 0; i < most_crossing_steps && d > 0 && d <= h + little_step * h; ++i) {
            const auto [x, x_dot] = series.at(d);
            const double step = halley(
                wall * (x - moved(y_left, rate_left, d)) - b, wall * (x_dot - y_dot_at(k * h + d)),
                f2 + 0.5 * wall * d * (jerk + 0.5 * d * snap));
            if (!(std::abs(step) <= little_step * h)) {
                d += step;
                continue;
            }
            const double s = k * h + (d + step);
            if (s > limit) return SearchResult::none;
            Oscillation at = flow.rotated(o, d);
            at.x = x, at.x_dot = x_dot;
            const double a = flow.acceleration(at), rate = flow.jerk(at);
            at = flow.rotated_little(at, step);
            at.x = x + step * (x_dot + 0.5 * step * a);
            at.x_dot = x_dot + step * (a + 0.5 * step * rate);
            contact.emplace(Contact{
                s, static_cast<int>(wall * mirror), mirrored(at),
                mirror * (at.x_dot - y_dot_at(s))});
            return SearchResult::contact;
        }
        return SearchResult::undecided;
    }

    /// The first cell of a flight that may return to its wall there, at most once if phi rises.
    SearchResult search_first(double right, std::optional<Contact>& contact) const {
        const double a = relative_acceleration(lo);
        if (is_released || !(3 * a > 2 * M3 * h)) return SearchResult::undecided;
        if (std::abs(right) < b - eta && right > -inside(h)) return SearchResult::none;
        return right < b + eta ? SearchResult::undecided : return_within(h, a, contact);
    }

    /// True if CellSearch::chatter() proves a return within D = 4 w/a.
    bool is_in_chatter(double a) const { return 4 * w <= a * h && 4 * w * M3 < a * a; }

    /// The return within D, where f = x - y - b = s phi(s) rises through 0 once; a = f''(0) > 0.
    SearchResult return_within(double D, double a, std::optional<Contact>& contact) const {
        if (D * (w + M2 * D) >= b) return SearchResult::undecided;
        const bool is_near = D <= near_reach * h;
        const Flow::ShortSeries series = is_near ? near_series(flow, lo) : flow.short_series(lo);
        const int size = is_near ? near_size : 2 * Flow::short_pairs;
        const double c2 = 0.5 * a, c3 = series.x[3], c4 = series.x[4];
        double s = w / c2;
        s -= s * s * (c3 + s * c4) / (c2 + s * (2 * c3 + 3 * s * c4));
        for (int i = 0; i < 8; ++i) {
            double phi = 0, rate = 0, half_curvature = 0;
            for (int n = size - 1; n > 0; --n) {
                half_curvature = half_curvature * s + rate;
                rate = rate * s + phi;
                phi = phi * s + (n > 2 ? series.x[n] : n == 2 ? series.x[2] - y_2 : -w);
            }
            const double step = halley(phi, rate, half_curvature);
            if (!(std::abs(step) <= last_chatter_step * s)) {
                s = std::clamp(s + step, 0.5 * w / a, D);
                continue;
            }
            s += step;
            if (s > limit) return SearchResult::none;
            Oscillation at = flow.rotated(lo, s);
            const auto [x, x_dot] = series.at(s);
            at.x = x, at.x_dot = x_dot;
            // f' = phi + s phi', with phi(s) = 0.
            contact.emplace(Contact{
                s, static_cast<int>(mirror), mirrored(at),
                mirror * s * (rate + step * 2 * half_curvature)});
            return SearchResult::contact;
        }
        return SearchResult::undecided;
    }
};

}  // namespace

std::optional<Contact> fast_contact(
    const Flow& flow, const FlightStart& start, double b, double limit,
    std::vector<GrazingPoint>& grazing) {
    std::optional<Contact> contact;
    // Through a function: with both searches in this one a run takes 2 % longer.
    const auto search = [&]<bool bends>(std::bool_constant<bends>) {
        return FastSearch<bends>{flow, start, b, limit}.search(contact);
    };
    if (!is_simple(start) || (start.y_2 == 0 ? search(std::false_type())
                                             : search(std::true_type())) == SearchResult::undecided)
        contact = next_contact(flow, start, b, limit, grazing);
    return contact;
}

}  // namespace vines
