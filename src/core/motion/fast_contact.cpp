#include "core/motion/contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace vines {

namespace {

// Last Halley step, relative to a cell (1.5e-7 absolute): the state is carried over it by its
// Taylor polynomial of second order. The curvature is accurate to 5e-4, so that the error of the
// step is below (1.5e-7)^2 5e-4 = 1e-17.
constexpr double little_step = 1e-6;
// Maximum number of steps to find a crossing; after that next_contact() takes over.
constexpr int most_crossing_steps = 4;

/// True for a ball that flies straight or under a constant force, and begins between the walls or
/// leaves a wall with non-zero relative velocity.
bool is_simple(const FlightStart& start) {
    return !start.shift &&
           (start.side == 0 || (start.zeros == 1 && start.side * start.relative_speed < 0));
}

enum class SearchResult { contact, none, undecided };

/// One flight, under a constant force if it `bends`. All positions are mirrored if it leaves the
/// wall at x - y = -b, so that a flight from a wall always leaves x - y = b.
template <bool bends>
struct FastSearch {
    const Flow& flow;
    bool leaves_wall;
    double mirror, b, limit;
    double w;  // relative speed away from the wall
    double y, y_dot, y_2;
    Oscillation lo;
    double h, M2, M3, eta;

    FastSearch(const Flow& f, const FlightStart& start, double half_width, double until)
        : flow(f),
          leaves_wall(start.side != 0),
          mirror(leaves_wall ? start.side : 1),
          b(half_width),
          limit(until),
          w(-mirror * start.relative_speed),
          y(mirror * start.y),
          y_dot(mirror * start.y_dot),
          y_2(mirror * start.y_2),
          lo(mirrored(start.lo)),
          h(f.cell()) {
        const Flow::Bounds bounds = f.bounds(lo);
        M2 = bounds.x_ddot + 2 * std::abs(y_2), M3 = bounds.x_dddot;
        eta = position_rounding(bounds, std::abs(y) + limit * limit * std::abs(y_2), b);
    }

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
        const int blocks =
            limit < flow.reach() ? static_cast<int>(limit / width) + 1 : Flow::cells / Flow::block;
        double left = leaves_wall ? b : lo.x - y;  // x - y at a block's left end
        bool left_inside = std::abs(left) < least;
        for (int from = 0; from < blocks; from += Flow::block) {
            Flow::Block ends = flow.relative_positions_apart(lo, y, y_dot, from);
            if constexpr (bends) ends -= y_2 * flow.squared_times_apart(from);
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
        Flow::Block ends = flow.relative_positions(lo, y, y_dot, from + 1);
        if constexpr (bends) ends -= y_2 * flow.squared_times(from + 1);
        const double least = inside(h);
        if (from == 0 && !leaves_wall && std::abs(left) >= b - eta) return SearchResult::undecided;
        for (int i = 0; i < Flow::block; ++i) {
            const int k = from + i;
            const double right = ends[i];
            if (k == 0 && leaves_wall) {
                if (!leaves(right, h, least)) return next_in_chatter(contact);
            } else if (std::abs(right) >= b - eta) {
                return crossing(k, left, right, contact);
            } else if (!(std::abs(left) < least && std::abs(right) < least)) {
                // Inside at both ends, and therefore empty if x - y is monotone.
                if (std::abs(flow.roughly_at(lo, k).x_dot - y_dot_at(k * h)) <= M2 * h)
                    return SearchResult::undecided;
            }
            left = right;
        }
        return SearchResult::none;
    }

    /// The contact in cell k if x - y is monotone there: the most common case of rule 4. A
    /// contact at the right grid point, as happens where half a cycle is a multiple of h, can be
    /// found one rounding error beyond it.
    SearchResult crossing(int k, double left, double right, std::optional<Contact>& contact) const {
        const double wall = right > 0 ? 1 : -1, f0 = wall * left - b, fh = wall * right - b;
        const Oscillation o = flow.roughly_at(lo, k);
        const double jerk = flow.jerk(o), snap = flow.snap(o), rate_left = y_dot_at(k * h);
        const double f1 = wall * (o.x_dot - rate_left), f2 = 0.5 * wall * relative_acceleration(o),
                     f3 = (1.0 / 6) * wall * jerk, f4 = (1.0 / 24) * wall * snap;
        if (f1 <= M2 * h || f0 >= 0) return SearchResult::undecided;

        // Root of the chord, corrected for curvature; one step on the quartic about the left end of
        // the cell, with a fifth term so that it matches f(h), which leaves an error of about 1e-8
        // h; then a step on the full series.
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

    /// The next contact of a chatter, if the conditions of CellSearch::chatter() prove it.
    SearchResult next_in_chatter(std::optional<Contact>& contact) const {
        const double a = relative_acceleration(lo);
        if (!(4 * w <= a * h)) return SearchResult::undecided;
        const double D = 4 * w / a;
        if (M3 * D >= a || D * (w + M2 * D) >= b) return SearchResult::undecided;
        // f = x - y - b is s phi(s).
        const Flow::ShortSeries series = flow.short_series(lo);
        const double c2 = 0.5 * a, c3 = flow.jerk(lo) / 6, c4 = flow.snap(lo) / 24;
        double s = w / c2;
        s -= s * s * (c3 + s * c4) / (c2 + s * (2 * c3 + 3 * s * c4));
        for (int i = 0; i < 8; ++i) {
            double phi = 0, rate = 0, half_curvature = 0;
            for (int n = 2 * Flow::short_pairs - 1; n > 0; --n) {
                half_curvature = half_curvature * s + rate;
                rate = rate * s + phi;
                phi = phi * s + (n > 2 ? series.x[n] : n == 2 ? series.x[2] - y_2 : -w);
            }
            const double step = halley(phi, rate, half_curvature);
            if (!(std::abs(step) <= last_chatter_step * s)) {
                s = std::clamp(s + step, 0.125 * D, D);
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
        return FastSearch<bends>(flow, start, b, limit).search(contact);
    };
    if (!is_simple(start) || (start.y_2 == 0 ? search(std::false_type())
                                             : search(std::true_type())) == SearchResult::undecided)
        contact = next_contact(flow, start, b, limit, grazing);
    return contact;
}

}  // namespace vines
