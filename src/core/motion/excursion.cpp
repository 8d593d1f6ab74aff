// Peak displacement and path length of the linear oscillator between events.
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/motion/flow.hpp"

namespace vines {

namespace {

bool signs_differ(double a, double b) { return (a < 0) != (b < 0); }

/// x at the zero of x' in 0 < d < width; x' changes its sign there and x'' does not. Newton
/// iteration; the last step follows the parabola, whose relative error is 1e-18.
double extremum_value(const Flow& flow, const Oscillation& left, double width, double x_dot_end) {
    constexpr double last_step = 1e-5;
    const Flow::ShortSeries series = flow.short_series(left);
    const double a = flow.acceleration(left), rate = flow.jerk(left), snap = flow.snap(left);
    double d = width * left.x_dot / (left.x_dot - x_dot_end);
    for (int step = 0;; ++step) {
        const auto [x, x_dot] = series.at(d);
        const double ahead = -x_dot / (a + d * (rate + 0.5 * d * snap));
        if (std::abs(ahead) <= last_step * width) return x + 0.5 * ahead * x_dot;
        // With almost no acceleration x hardly changes.
        if (step == 8 || !(std::abs(ahead) <= width)) return x;
        d = std::clamp(d + ahead, 0.0, width);
    }
}

/// Visits the extrema of x from `left` to `right`: one at most, two if x'' changes its sign.
template <class Visit>
void visit_extrema(
    const Flow& flow, const Oscillation& left, double width, const Oscillation& right,
    const Visit& visit) {
    const auto part = [&](const Oscillation& from, double length, const Oscillation& to) {
        if (length > 0 && signs_differ(from.x_dot, to.x_dot))
            visit(extremum_value(flow, from, length, to.x_dot));
    };
    const double a = flow.acceleration(left), b = flow.acceleration(right);
    if (!signs_differ(a, b)) return part(left, width, right);
    // x'' = 0 by one secant and one Newton step: x' hardly changes near that point.
    const Flow::ShortSeries series = flow.short_series(left);
    const auto at = [&](double d) {
        Oscillation o = flow.rotated(left, d);
        const auto [x, x_dot] = series.at(d);
        o.x = x, o.x_dot = x_dot;
        return o;
    };
    double d = width * a / (a - b);
    Oscillation middle = at(d);
    const double slope = flow.jerk(middle);
    if (slope != 0) d = std::clamp(d - flow.acceleration(middle) / slope, 0.0, width);
    middle = at(d);
    part(left, d, middle);
    part(middle, width - d, right);
}

/// Visits x of the motion of a flow plus a polynomial: at the start, at its extrema, at the end.
template <class Visit>
void visit_extrema(
    const Flow& flow, const Oscillation& start, const Polynomial& shift, double from, double to,
    const Visit& visit) {
    struct Point {
        double s, x, x_dot, x_ddot;
    };
    const auto at = [&](double s) {
        const Oscillation o = flow.after(start, s);
        return Point{
            s, o.x + shift.at(s), o.x_dot + shift.rate(s), flow.acceleration(o) + shift.second(s)};
    };
    // Bisects until x differs from its extremum by no more than an ulp.
    const auto zero_of = [&](double Point::* member, Point low, Point high) {
        while (high.s - low.s > 1e-8 * flow.cell()) {
            const Point middle = at(0.5 * (low.s + high.s));
            (signs_differ(low.*member, middle.*member) ? high : low) = middle;
        }
        return low;
    };
    const auto part = [&](const Point& left, const Point& right) {
        if (signs_differ(left.x_dot, right.x_dot)) visit(zero_of(&Point::x_dot, left, right).x);
    };
    Point left = at(from);
    visit(left.x);
    while (left.s < to) {
        const Point right = at(std::min(to, left.s + flow.cell()));
        if (signs_differ(left.x_ddot, right.x_ddot)) {
            const Point middle = zero_of(&Point::x_ddot, left, right);
            part(left, middle), part(middle, right);
        } else {
            part(left, right);
        }
        left = right;
    }
    visit(left.x);
}

/// Search for the peak over one grid length: the motion from o, for at most the reach of the flow.
struct PeakSearch {
    const Flow& flow;
    const Oscillation& o;
    double part;
    double known;
    double h = flow.cell();
    int cells = std::min(static_cast<int>(part / h), Flow::cells);
    Flow::Bounds bounds = flow.bounds(o, part);

    double peak() {
        known = std::max(known, std::abs(o.x));
        if (bounds.x <= known) return known;
        // Rule 1 of contact_search.hpp, applied from blocks of cells to cells to an extremum in a
        // cell.
        const double width = Flow::block * h, more = bounds.x_ddot * (width * width / 8);
        double left = o.x;
        const int blocks = cells / Flow::block;
        for (int from = 0; from < blocks; from += Flow::block) {
            const Flow::Block ends = flow.block_ends.relative_positions(o, 0, 0, from);
            for (int i = 0; i < Flow::block && from + i < blocks; ++i) {
                if (std::max(std::abs(left), std::abs(ends[i])) + more > known)
                    search_block((from + i) * Flow::block, left, ends[i], more);
                left = ends[i];
            }
        }
        if (cells % Flow::block != 0) search_cells(blocks * Flow::block, left, cells % Flow::block);
        search_remainder();
        return known;
    }

    /// Far from the middle the spring force dominates: x'' has no zero there, and x' at most one.
    void search_block(int from, double left, double right, double more) {
        const double stiffness = flow.coefficients()[0],
                     rest = bounds.x_ddot - stiffness * bounds.x,
                     least = std::min(std::abs(left), std::abs(right)) - more;
        if (signs_differ(left, right) || stiffness * least <= rest)
            return search_cells(from, left, Flow::block);
        known = std::max({known, std::abs(left), std::abs(right)});
        double before = flow.speed_at(o, from);
        if (!signs_differ(before, flow.speed_at(o, from + Flow::block))) return;
        for (int k = from + 1; k <= from + Flow::block; ++k) {
            const double now = flow.speed_at(o, k);
            if (signs_differ(before, now)) {
                // The motion goes no further than with its present speed.
                const Oscillation o_left = flow.roughly_at(o, k - 1);
                if (std::abs(o_left.x) + std::abs(o_left.x_dot) * h > known)
                    visit(extremum_value(flow, o_left, h, now));
                return;
            }
            before = now;
        }
    }

    void search_cells(int from, double left, int count) {
        const Flow::Block ends = flow.grid.relative_positions(o, 0, 0, from + 1);
        const double more = bounds.x_ddot * (h * h / 8);
        for (int i = 0; i < count; ++i) {
            visit(ends[i]);
            if (std::max(std::abs(left), std::abs(ends[i])) + more > known)
                extrema(flow.roughly_at(o, from + i), h, flow.roughly_at(o, from + i + 1));
            left = ends[i];
        }
    }

    /// The part after the last whole cell.
    void search_remainder() {
        const double d = part - cells * h;
        if (!(d > 0)) return;
        const Oscillation left = flow.roughly_at(o, cells);
        if (std::abs(left.x) + d * (std::abs(left.x_dot) + 0.5 * d * bounds.x_ddot) <= known)
            return;
        const Oscillation right = flow.after(left, d);
        visit(right.x);
        extrema(left, d, right);
    }

    void extrema(const Oscillation& left, double width, const Oscillation& right) {
        visit_extrema(flow, left, width, right, [this](double x) { visit(x); });
    }
    void visit(double x) { known = std::max(known, std::abs(x)); }
};

}  // namespace

double peak_beyond(double known, const Flow& flow, Oscillation o, double duration) {
    for (; duration > flow.reach(); duration -= flow.reach()) {
        known = PeakSearch{flow, o, flow.reach(), known}.peak();
        o = flow.at(o, Flow::cells);
    }
    return PeakSearch{flow, o, std::max(0.0, duration), known}.peak();
}

double peak_beyond(
    double known, const Flow& flow, const Oscillation& start, const Polynomial& shift, double from,
    double to) {
    if (shift.is_zero())
        return peak_beyond(known, flow, from > 0 ? flow.after(start, from) : start, to - from);
    visit_extrema(
        flow, start, shift, from, to, [&](double x) { known = std::max(known, std::abs(x)); });
    return known;
}

double path_length(
    const Flow& flow, const Oscillation& start, const Polynomial& shift, double from, double to) {
    double path = 0;
    std::optional<double> last;
    visit_extrema(flow, start, shift, from, to, [&](double x) {
        path += std::abs(x - last.value_or(x));
        last = x;
    });
    return path;
}

}  // namespace vines
