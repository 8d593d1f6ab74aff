#include "dense_flight.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace vines::hunt {

namespace {

using Real = SeriesMotion::Real;
using Place = SeriesMotion::Place;
using Series = SeriesMotion::Series;

constexpr Real allowed_ulps = 16 * static_cast<Real>(std::numeric_limits<double>::epsilon());

Real value(const Series& c, Real d) {
    Real sum = 0;
    for (std::size_t n = c.size(); n-- > 0;) sum = sum * d + c[n];
    return sum;
}

Real rate(const Series& c, Real d) {
    Real sum = 0;
    for (std::size_t n = c.size(); n-- > 1;) sum = sum * d + static_cast<Real>(n) * c[n];
    return sum;
}

/// Maximum over (0, length] of a polynomial minus its allowed rounding, or a lower value if that is
/// proven to be negative.
class Excess {
public:
    Excess(const Series& c, Real length, Real allowed, Real allowed_rate)
        : c_(c),
          allowed_(allowed),
          allowed_rate_(allowed_rate),
          length_(length) {
        Real power = 1;
        for (std::size_t n = 2; n < c.size(); ++n, power *= length)
            curvature_ += static_cast<Real>(n * (n - 1)) * std::abs(c[n]) * power;
    }
    Real most() const { return between(0, at(0), length_, at(length_)); }

private:
    Real at(Real d) const { return value(c_, d) - (allowed_ + allowed_rate_ * d); }
    Real between(Real a, Real fa, Real e, Real fe) const {
        const Real higher = std::max(fa, fe), width = e - a;
        if (higher > 0 || higher + curvature_ * width * width / 8 <= 0 || width < 1e-12L * length_)
            return higher;
        const Real middle = (a + e) / 2, fm = at(middle);
        const Real left = between(a, fa, middle, fm);
        return left > 0 ? left : between(middle, fm, e, fe);
    }

    const Series& c_;
    const Real allowed_, allowed_rate_, length_;
    Real curvature_ = 0;
};

class Judge {
public:
    Judge(const Flow& flow, const FlightStart& start, double b)
        : motion_(flow.coefficients()),
          side_(start.side),
          b_(b),
          // For a flight from a wall, the wall and the leaving speed are exact, not y and y'.
          y_(side_ != 0 ? Real(start.lo.x) - side_ * Real(b) : Real(start.y)),
          y_dot_(
              side_ != 0 ? Real(start.lo.x_dot) - Real(start.relative_speed) : Real(start.y_dot)),
          leaving_(start.relative_speed),
          first_cell_(flow.cell()),
          from_(place_of(start.lo)),
          place_(from_),
          sizes_(std::abs(from_.x) + std::abs(from_.x_dot)),
          own_(motion_.series(from_)) {
        for (std::size_t n = 0; n + 1 < own_.size(); ++n) own_[n] = side_ * own_[n + 1];
        own_[0] = side_ * leaving_;
        own_.back() = 0;
    }

    FlightJudgement judge(double limit, const std::optional<Contact>& found) {
        const Real end = found ? found->s : limit;
        // If a search ended a rounding error before a wall, the next one starts at the wall.
        if (found && !(found->s >= 0 && found->s <= limit && (found->s > 0 || side_ == 0)))
            return {"a contact outside the search"};
        if (side_ != 0) leave(std::min(first_cell_, end));
        Real s = 0;
        for (; s + motion_.step() < end; s += motion_.step()) pass(s, motion_.step());
        pass(s, end - s);
        if (found) meet(*found, s);
        return result_;
    }

private:
    Real allowed(Real s) const {
        return allowed_ulps *
               (sizes_ + motion_.forcing() * s + b_ + std::abs(y_) + std::abs(y_dot_) * s);
    }
    Real allowed_speed(Real s) const {
        return allowed_ulps * (sizes_ + motion_.forcing() * s + std::abs(y_dot_));
    }
    /// For (x - y - side b)/s: from its first term, and from the terms with x''.
    Real allowed_at_wall() const { return allowed_ulps * std::abs(leaving_); }
    Real allowed_at_wall_rate() const {
        return allowed_ulps *
               (std::abs(from_.x) + motion_.damping() * std::abs(from_.x_dot) + motion_.forcing());
    }
    void note(Real excess, Real allowed, const char* what) {
        result_.worst = std::max(result_.worst, 1 + excess / allowed);
        if (excess > 0 && result_.wrong.empty()) result_.wrong = what;
    }

    /// The flight's own wall over the first cell: (x - y - side b)/s remains below zero.
    void leave(Real end) {
        const Real excess = Excess(own_, end, allowed_at_wall(), allowed_at_wall_rate()).most();
        if (excess > 0)
            note(
                excess, allowed_at_wall() + allowed_at_wall_rate() * end,
                "missed contact: its own wall");
    }

    /// Both walls over a step of this length from s.
    void pass(Real s, Real length) {
        const Place next = length == motion_.step() ? motion_.next(place_) : place_;
        const Real left = place_.x - (y_ + y_dot_ * s),
                   right = next.x - (y_ + y_dot_ * (s + length));
        const Real bulge = motion_.acceleration_bound(place_) * length * length / 8;
        if (length != motion_.step() || std::max(std::abs(left), std::abs(right)) + bulge > b_) {
            Series g = motion_.series(place_);
            g[0] = left;
            g[1] -= y_dot_;
            for (int wall : {1, -1}) {
                // Checked by leave().
                if (wall == side_ && s + length <= first_cell_) continue;
                const Real may = allowed(s + length);
                Series f;
                for (std::size_t n = 0; n < f.size(); ++n) f[n] = wall * g[n];
                f[0] -= b_;
                if (wall == side_ && s < first_cell_) {
                    // The first cell ends within this step: check the part after it.
                    note_beyond(s, length, may);
                    continue;
                }
                note(Excess(f, length, may, 0).most(), may, "missed contact");
            }
        }
        if (length == motion_.step()) place_ = next;
    }

    void note_beyond(Real s, Real length, Real may) {
        const Real skip = first_cell_ - s;
        const Place from = motion_.after(place_, skip);
        Series f = motion_.series(from);
        f[0] -= y_ + y_dot_ * first_cell_;
        f[1] -= y_dot_;
        for (Real& c : f) c *= side_;
        f[0] -= b_;
        note(Excess(f, length - skip, may, 0).most(), may, "missed contact: its own wall");
    }

    /// place_ is the state at s.
    void meet(const Contact& found, Real s) {
        const Real at = found.s, d = at - s;
        if (found.side * found.relative_speed < 0)
            result_.wrong = "a contact that moves away from the wall";
        Series g = motion_.series(place_);
        g[0] -= y_ + y_dot_ * s;
        g[1] -= y_dot_;
        Real off = std::abs(value(g, d) - found.side * b_), may = allowed(at);
        Real fast = rate(g, d), may_differ = allowed_speed(at);
        // A contact at the grid point where the first cell ends belongs to the next cell.
        if (found.side == side_ && at < first_cell_) {
            off = std::abs(value(own_, at)), may = allowed_at_wall() + allowed_at_wall_rate() * at;
            fast = side_ * (value(own_, at) + at * rate(own_, at)), may_differ = may;
        }
        note(off - may, may, "a contact away from the walls");
        const Real difference = std::abs(fast - found.relative_speed);
        note(difference - may_differ, may_differ, "a wrong relative speed");
    }

    const SeriesMotion motion_;
    const int side_;
    const Real b_, y_, y_dot_, leaving_, first_cell_;
    const Place from_;
    Place place_;
    const Real sizes_;
    Series own_;  // of (side (x - y) - b)/s
    FlightJudgement result_;
};

}  // namespace

SeriesMotion::SeriesMotion(const Flow::Coefficients& c)
    : stiffness_(c[0]),
      damping_(c[1]),
      forcing_(c[2]),
      Omega_(c[3]),
      step_(2 * std::numbers::pi_v<Real> / 200 / std::max({Real(1), Omega_, damping_})) {
    for (int part = 0; part < 4; ++part)
        over_step_[static_cast<std::size_t>(part)] =
            by_series({Real(part == 0), Real(part == 1), Real(part == 2), Real(part == 3)}, step_);
}

Series SeriesMotion::series(const Place& p) const {
    Series c;
    c[0] = p.x;
    c[1] = p.x_dot;
    // Coefficient n of sin(theta + Omega d), alternately from sin and cos.
    Real sin = p.sin, cos = p.cos;
    for (int n = 0; n + 2 < terms; ++n) {
        const auto i = static_cast<std::size_t>(n);
        c[i + 2] = (-stiffness_ * c[i] - damping_ * (n + 1) * c[i + 1] + forcing_ * sin) /
                   ((n + 1) * static_cast<Real>(n + 2));
        const Real turned = Omega_ * cos / (n + 1);
        cos = -Omega_ * sin / (n + 1);
        sin = turned;
    }
    return c;
}

Place SeriesMotion::by_series(const Place& p, Real d) const {
    const Series c = series(p);
    const Real s = std::sin(Omega_ * d), k = std::cos(Omega_ * d);
    return {value(c, d), rate(c, d), p.sin * k + p.cos * s, p.cos * k - p.sin * s};
}

Place SeriesMotion::next(const Place& p) const {
    const auto& [x, v, s, c] = over_step_;
    return {
        x.x * p.x + v.x * p.x_dot + s.x * p.sin + c.x * p.cos,
        x.x_dot * p.x + v.x_dot * p.x_dot + s.x_dot * p.sin + c.x_dot * p.cos,
        s.sin * p.sin + c.sin * p.cos, s.cos * p.sin + c.cos * p.cos};
}

Place SeriesMotion::after(Place p, Real s) const {
    for (; s > step_; s -= step_) p = next(p);
    return by_series(p, s);
}

Real SeriesMotion::acceleration_bound(const Place& p) const {
    const Real root = std::sqrt(stiffness_),
               speed = root * std::abs(p.x) + std::abs(p.x_dot) + forcing_ * step_;
    return (root + damping_) * speed + forcing_;
}

Place place_of(const Oscillation& lo) { return {lo.x, lo.x_dot, lo.sin_theta, lo.cos_theta}; }

FlightJudgement judge_flight(
    const Flow& flow, const FlightStart& start, double b, double limit,
    const std::optional<Contact>& found) {
    return Judge(flow, start, b).judge(limit, found);
}

}  // namespace vines::hunt
