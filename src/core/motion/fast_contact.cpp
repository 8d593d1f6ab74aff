#include "core/motion/fast_contact.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

enum class Found { contact, none, doubt };

/// A flight, with the signs of all positions changed where it leaves the wall at x - y = -b: if it
/// leaves one at all, it leaves x - y = b.
struct Flight {
    const Flow& flow;
    bool leaves_wall;
    double mirror, b, limit;
    double w;  // the speed at which it leaves
    double y, y_dot;
    Oscillation lo;
    double h, M2, M3, eta;

    Flight(const Flow& f, const FlightStart& start, double half_width, double until)
        : flow(f),
          leaves_wall(start.side != 0),
          mirror(leaves_wall ? start.side : 1),
          b(half_width),
          limit(until),
          w(-mirror * start.relative_speed),
          y(mirror * start.y),
          y_dot(mirror * start.y_dot),
          lo(mirrored(start.lo)),
          h(f.cell()) {
        const Flow::Bounds bounds = f.bounds(lo);
        M2 = bounds.x_ddot, M3 = bounds.x_dddot;
        eta = position_rounding(bounds, y, b);
    }

    Oscillation mirrored(const Oscillation& o) const {
        return {mirror * o.x, mirror * o.x_dot, mirror * o.sin_theta, mirror * o.cos_theta};
    }

    /// Property 1: no contact between two points this far apart if x - y is within it at both.
    double inside(double width) const { return b - M2 * (width * width / 8) - eta; }

    /// Properties 2 and, of the other wall, 1, over the first stretch of such a width.
    bool leaves(double right, double width, double inside) const {
        const double least = M3 * (width * width / 24) + eta / width;
        return w > least && b - right > least * width && right > -inside;
    }

    /// Blocks of cells, and the cells of those that are not proven empty as a whole.
    Found search(std::optional<Contact>& contact) const {
        const double width = Flow::block * h, least = inside(width);
        const int blocks =
            limit < flow.reach() ? static_cast<int>(limit / width) + 1 : Flow::cells / Flow::block;
        double left = leaves_wall ? b : lo.x - y;  // x - y at a block's left end
        bool left_inside = std::abs(left) < least;
        for (int from = 0; from < blocks; from += Flow::block) {
            const Flow::Block ends = flow.relative_positions_apart(lo, y, y_dot, from);
            for (int i = 0; i < Flow::block && from + i < blocks; ++i) {
                const double right = ends[i];
                const bool right_inside = std::abs(right) < least;
                const bool empty = from + i == 0 && leaves_wall ? leaves(right, width, least)
                                                                : left_inside && right_inside;
                if (!empty) {
                    const Found found = look(from + i, left, contact);
                    if (found != Found::none) return found;
                }
                left = right;
                left_inside = right_inside;
            }
        }
        return Found::none;
    }

    Found look(int block, double left, std::optional<Contact>& contact) const {
        const int from = Flow::block * block;
        const Flow::Block ends = flow.relative_positions(lo, y, y_dot, from + 1);
        const double least = inside(h);
        if (from == 0 && !leaves_wall && std::abs(left) >= b - eta) return Found::doubt;
        for (int i = 0; i < Flow::block; ++i) {
            const int k = from + i;
            const double right = ends[i];
            if (k == 0 && leaves_wall) {
                if (!leaves(right, h, least)) return hop(contact);
            } else if (std::abs(right) >= b - eta) {
                return crossing(k, left, right, contact);
            } else if (!(std::abs(left) < least && std::abs(right) < least)) {
                // Inside at both ends, and so empty if x - y is monotone.
                if (std::abs(flow.roughly_at(lo, k).x_dot - y_dot) <= M2 * h) return Found::doubt;
            }
            left = right;
        }
        return Found::none;
    }

    /// Of cell k, if x - y is monotone there: property 4's commonest case. A contact at the grid
    /// point to the right, as it is where half a cycle is a multiple of h, may come out a rounding
    /// error behind it.
    Found crossing(int k, double left, double right, std::optional<Contact>& contact) const {
        const double wall = right > 0 ? 1 : -1, f0 = wall * left - b, fh = wall * right - b;
        const Oscillation o = flow.roughly_at(lo, k);
        const double x_ddot = flow.acceleration(o), jerk = flow.jerk(o), snap = flow.snap(o);
        const double f1 = wall * (o.x_dot - y_dot), f2 = 0.5 * wall * x_ddot,
                     f3 = (1.0 / 6) * wall * jerk, f4 = (1.0 / 24) * wall * snap;
        if (f1 <= M2 * h || f0 >= 0) return Found::doubt;

        // The chord's root, corrected by the curvature; a step on the quartic at the cell's left
        // end with a fifth term so that it meets f(h), which leaves an error of some 1e-8 h; a step
        // on the whole series.
        const double per_h = 1 / h, slope = (fh - f0) * per_h, inverse_slope = 1 / slope;
        const double f5 = ((((slope - f1) * per_h - f2) * per_h - f3) * per_h - f4) * per_h;
        double d = -f0 * inverse_slope;
        d += f2 * d * (h - d) * inverse_slope;
        d += halley(
            f0 + d * (f1 + d * (f2 + d * (f3 + d * (f4 + d * f5)))),
            f1 + d * (2 * f2 + d * (3 * f3 + d * (4 * f4 + d * (5 * f5)))),
            f2 + d * (3 * f3 + d * (6 * f4 + d * (10 * f5))));
        const Flow::Near series = flow.near_series(o);
        const double y_left = y + y_dot * (k * h);
        for (int i = 0; i < most_crossing_steps && d > 0 && d <= h + little_step * h; ++i) {
            const auto [x, x_dot] = series.at(d);
            const double step = halley(
                wall * (x - (y_left + y_dot * d)) - b, wall * (x_dot - y_dot),
                f2 + 0.5 * wall * d * (jerk + 0.5 * d * snap));
            if (!(std::abs(step) <= little_step * h)) {
                d += step;
                continue;
            }
            const double s = k * h + (d + step);
            if (s > limit) return Found::none;
            Oscillation at = flow.turned(o, d);
            at.x = x, at.x_dot = x_dot;
            const double a = flow.acceleration(at), rate = flow.jerk(at);
            at = flow.turned_little(at, step);
            at.x = x + step * (x_dot + 0.5 * step * a);
            at.x_dot = x_dot + step * (a + 0.5 * step * rate);
            contact.emplace(Contact{
                s, static_cast<int>(wall * mirror), mirrored(at), mirror * (at.x_dot - y_dot)});
            return Found::contact;
        }
        return Found::doubt;
    }

    /// The next contact of a chatter, where guard.cpp's conditions prove it.
    Found hop(std::optional<Contact>& contact) const {
        const double a = flow.acceleration(lo);
        if (!(4 * w <= a * h)) return Found::doubt;
        const double longest = 4 * w / a;
        if (M3 * longest >= a || longest * (w + M2 * longest) >= b) return Found::doubt;
        // f = x - y - b is s phi(s).
        const Flow::Near series = flow.near_series(lo);
        const double c2 = 0.5 * a, c3 = flow.jerk(lo) / 6, c4 = flow.snap(lo) / 24;
        double s = w / c2;
        s -= s * s * (c3 + s * c4) / (c2 + s * (2 * c3 + 3 * s * c4));
        for (int i = 0; i < 8; ++i) {
            double phi = 0, rate = 0, half_curvature = 0;
            for (int n = 2 * Flow::near_pairs - 1; n > 0; --n) {
                half_curvature = half_curvature * s + rate;
                rate = rate * s + phi;
                phi = phi * s + (n > 1 ? series.x[n] : -w);
            }
            const double step = halley(phi, rate, half_curvature);
            if (!(std::abs(step) <= last_step_of_chatter * s)) {
                s = std::clamp(s + step, 0.125 * longest, longest);
                continue;
            }
            s += step;
            if (s > limit) return Found::none;
            Oscillation at = flow.turned(lo, s);
            const auto [x, x_dot] = series.at(s);
            at.x = x, at.x_dot = x_dot;
            // f' = phi + s phi', with phi(s) = 0.
            contact.emplace(Contact{
                s, static_cast<int>(mirror), mirrored(at),
                mirror * s * (rate + step * 2 * half_curvature)});
            return Found::contact;
        }
        return Found::doubt;
    }
};

}  // namespace

bool is_plain(const FlightStart& start) {
    return start.side == 0 || (start.zeros == 1 && start.side * start.relative_speed < 0);
}

std::optional<Contact> fast_contact(
    const Flow& flow, const FlightStart& start, double b, double limit,
    std::vector<Touch>& touches) {
    std::optional<Contact> contact;
    if (!is_plain(start) || Flight(flow, start, b, limit).search(contact) == Found::doubt)
        contact = next_contact(flow, start, b, limit, touches);
    return contact;
}

}  // namespace vines
