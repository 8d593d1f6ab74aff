#include "core/motion/excursion.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

/// x where x' = 0 within 0 < d < width from `left`, x' being of opposite signs at the two ends.
/// Newton's steps with an acceleration that is right to 1e-5 of itself: after two of them the
/// turning point is 1e-7 off, and x by the square of what the last correction leaves of that.
double turning_value(const Flow& flow, const Oscillation& left, double width, double x_dot_end) {
    const Flow::Near series = flow.near_series(left);
    const double a = flow.acceleration(left), rate = flow.jerk(left), snap = flow.snap(left);
    double d = width * left.x_dot / (left.x_dot - x_dot_end);
    for (int step = 0;; ++step) {
        const auto [x, x_dot] = series.at(d);
        const double ahead = -x_dot / (a + d * (rate + 0.5 * d * snap));
        // Hardly any acceleration: then x hardly changes.
        if (!(std::abs(ahead) <= width)) return x;
        if (step == 2) return x + 0.5 * ahead * x_dot;
        d = std::clamp(d + ahead, 0.0, width);
    }
}

/// One look at the grid: the flight from o on, for a part of the flow's reach.
class Look {
public:
    Look(double known, const Flow& flow, const Oscillation& o, double part)
        : known_(std::max(known, std::abs(o.x))),
          flow_(flow),
          o_(o),
          h_(flow.cell()),
          part_(part),
          cells_(std::min(static_cast<int>(part / h_), Flow::cells)),
          bounds_(flow.bounds(o, part)) {}

    double peak() {
        if (bounds_.x <= known_) return known_;
        // x differs from its chord over a width w by at most M2 w^2/8: blocks of cells, the cells
        // of those blocks, and within those cells the turning point.
        const double width = Flow::block * h_, more = bounds_.x_ddot * (width * width / 8);
        double left = o_.x;
        const int blocks = cells_ / Flow::block;
        for (int from = 0; from < blocks; from += Flow::block) {
            const Flow::Block ends = flow_.relative_positions_apart(o_, 0, 0, from);
            for (int i = 0; i < Flow::block && from + i < blocks; ++i) {
                if (std::max(std::abs(left), std::abs(ends[i])) + more > known_)
                    block((from + i) * Flow::block, left, ends[i], more);
                left = ends[i];
            }
        }
        if (cells_ % Flow::block != 0) cells(blocks * Flow::block, left, cells_ % Flow::block);
        rest();
        return known_;
    }

private:
    /// Far from the middle the spring outdoes all else: then x'' does not vanish, and x' vanishes
    /// once, if it changes its sign.
    void block(int from, double left, double right, double more) {
        const double stiffness = flow_.coefficients()[0],
                     rest = bounds_.x_ddot - stiffness * bounds_.x,
                     least = std::min(std::abs(left), std::abs(right)) - more;
        if (left * right < 0 || stiffness * least <= rest) return cells(from, left, Flow::block);
        known_ = std::max({known_, std::abs(left), std::abs(right)});
        double before = flow_.speed_at(o_, from);
        if (before * flow_.speed_at(o_, from + Flow::block) > 0) return;
        for (int k = from + 1; k <= from + Flow::block; ++k) {
            const double now = flow_.speed_at(o_, k);
            if (before * now <= 0) return turn(flow_.roughly_at(o_, k - 1), h_, now);
            before = now;
        }
    }

    void cells(int from, double left, int count) {
        const Flow::Block ends = flow_.relative_positions(o_, 0, 0, from + 1);
        const double more = bounds_.x_ddot * (h_ * h_ / 8);
        for (int i = 0; i < count; ++i) {
            known_ = std::max(known_, std::abs(ends[i]));
            if (std::max(std::abs(left), std::abs(ends[i])) + more > known_)
                turn(flow_.roughly_at(o_, from + i), h_, flow_.roughly_at(o_, from + i + 1).x_dot);
            left = ends[i];
        }
    }

    /// Behind the last whole cell.
    void rest() {
        const double d = part_ - cells_ * h_;
        if (!(d > 0)) return;
        const Oscillation left = flow_.roughly_at(o_, cells_);
        if (std::abs(left.x) + d * (std::abs(left.x_dot) + 0.5 * d * bounds_.x_ddot) <= known_)
            return;
        const auto [x, x_dot] = flow_.near_series(left).at(d);
        known_ = std::max(known_, std::abs(x));
        turn(left, d, x_dot);
    }

    /// Up to a turning point |x'| falls: x comes no further than it would at its speed now.
    void turn(const Oscillation& left, double width, double x_dot_end) {
        if (left.x_dot * x_dot_end < 0 && std::abs(left.x) + std::abs(left.x_dot) * width > known_)
            known_ = std::max(known_, std::abs(turning_value(flow_, left, width, x_dot_end)));
    }

    double known_;
    const Flow& flow_;
    const Oscillation& o_;
    const double h_, part_;
    const int cells_;
    const Flow::Bounds bounds_;
};

}  // namespace

double peak_beyond(double known, const Flow& flow, Oscillation o, double duration) {
    for (; duration > flow.reach(); duration -= flow.reach()) {
        known = Look(known, flow, o, flow.reach()).peak();
        o = flow.at(o, Flow::cells);
    }
    return Look(known, flow, o, std::max(0.0, duration)).peak();
}

double path_length(const Flow& flow, Oscillation o, double duration) {
    double path = 0, last = o.x;
    const auto visit = [&](double x) {
        path += std::abs(x - last);
        last = x;
    };
    // Within a cell x' changes its sign once, or so little that rounding cannot tell.
    const auto turn = [&](const Oscillation& left, double width, double x_dot_end) {
        if (left.x_dot * x_dot_end < 0) visit(turning_value(flow, left, width, x_dot_end));
    };
    while (duration > 0) {
        const double part = std::min(duration, flow.reach());
        const int cells = std::min(static_cast<int>(part / flow.cell()), Flow::cells);
        Oscillation left = o;
        for (int k = 1; k <= cells; ++k) {
            const Oscillation right = flow.at(o, k);
            turn(left, flow.cell(), right.x_dot);
            left = right;
        }
        const double d = std::max(0.0, part - cells * flow.cell());
        o = flow.along(flow.series(left), left, d);
        turn(left, d, o.x_dot);
        visit(o.x);
        duration -= part;
    }
    return path;
}

}  // namespace vines
