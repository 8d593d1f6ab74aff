// A run, flight by flight: state of the motion and notification of the observers.
#include "core/motion/simulate.hpp"

#include <cassert>
#include <cmath>
#include <memory>
#include <type_traits>

#include "core/motion/elementary.hpp"
#include "core/motion/load.hpp"

namespace vines {

namespace {

// A chatter ends when its remaining duration is below this, less than the accuracy of any result;
// the relative speed is near 1e-12 of a typical one, far above the effect of rounding.
constexpr double chatter_rest = 1e-9;
// A sliding ball reverses within each bounce, where its position rounds: its chatter ends when its
// remaining duration is below this, or when its bounces are as low as this many rounding errors.
constexpr double sliding_chatter_rest = 1e-6, lowest_bounce = 100;
// Largest relative change of the acceleration for which that is a geometric series.
constexpr double chatter_drift = 1e-4;

int sign_of(double value) { return (value > 0) - (value < 0); }

/// Time as a sum of two doubles: adding a million small steps loses no accuracy.
class Clock {
public:
    explicit Clock(double tau) : high_(tau) {}
    double tau() const { return high_ + low_; }
    double until(double end) const { return (end - high_) - low_; }
    void advance(double s) {
        const double sum = high_ + s, part = sum - high_;
        low_ += (high_ - (sum - part)) + (s - part);
        high_ = sum;
    }

private:
    double high_, low_ = 0;
};

/// A run in progress. Parameters, limits and observers must outlive it.
class Run {
public:
    Run(const Parameters& p, const State& start, const Limits& limits,
        std::span<Observer* const> observers)
        : p_(p),
          limits_(limits),
          observers_(observers),
          clock_(limits.tau_start),
          y_(start.y),
          y_dot_(start.y_dot),
          side_(wall_of(start, p.b)),
          relative_speed_(start.x_dot - start.y_dot) {
        const double theta = p.Omega * limits.tau_start + p.phi();
        lo_ = {start.x, start.x_dot, elementary::sin(theta), elementary::cos(theta)};
        // Where gravity holds it, positions round more than x and y say.
        const double apart = start.x - start.y, sag = p.epsilon * std::abs(p.gravity),
                     rounding = position_rounding(free_->bounds(lo_), std::abs(start.y) + sag, p.b);
        if (side_ == 0 && sag > 0 && std::abs(apart) >= p.b - rounding) side_ = sign_of(apart);
        assert(is_physical(p));
        assert(p.load || std::abs(apart) <= p.b + rounding);
        if (p.load) interval_ = p.load->interval_at(limits.tau_start);
        begin_sliding(sign_of(relative_speed_));
        if (side_ != 0) {
            y_ = lo_.x - side_ * p.b;
            if (side_ * relative_speed_ > 0)
                strike({0, side_, lo_, relative_speed_}, relative_acceleration(of_flow(), 0));
            else leave_or_stick();
        } else if (p.friction > 0 && relative_speed_ == 0) {
            stop_sliding(0);
        }
    }

    Outcome run_to_end() {
        while (!is_over()) fly();
        return {*end_, clock_.tau(), {lo_.x_dot, lo_.x, y_dot_, y_}, impacts_};
    }

private:
    bool is_over() {
        if (!end_ && std::max(impacts_, others_) >= limits_.max_impacts) end_ = End::max_impacts;
        if (!end_ && limits_.stop && --until_look_ <= 0) {
            until_look_ = limits_.events_per_look;
            if (limits_.stop()) end_ = End::stopped;
        }
        return end_.has_value();
    }

    template <class... Arguments>
    void notify(
        void (Observer::*event)(Arguments...), std::type_identity_t<Arguments>... arguments) {
        for (Observer* o : observers_) (o->*event)(arguments...);
    }

    FlightStart flight() const {
        if (!forces_) return {lo_, y_, y_dot_, side_, relative_speed_, zeros_};
        const Polynomial& p = forces_->shift;
        return {of_flow(),       y_ - p[0], y_dot_ - p[1],         side_,
                relative_speed_, zeros_,    0.5 * forces_->y_ddot, p.size > 2 ? &p : nullptr};
    }

    // The oscillator without the forces' shift, and with it from a state of the flow at s.
    Oscillation of_flow() const {
        if (!forces_) return lo_;
        const Polynomial& p = forces_->shift;
        return {lo_.x - p[0], lo_.x_dot - p[1], lo_.sin_theta, lo_.cos_theta};
    }
    Oscillation with_shift(Oscillation o, double s) const {
        if (forces_) o.x += forces_->shift.at(s), o.x_dot += forces_->shift.rate(s);
        return o;
    }
    double y_ddot() const { return forces_ ? forces_->y_ddot : 0; }
    /// x'' - y'' of the free ball after s.
    double relative_acceleration(const Oscillation& flow_after, double s) const {
        const double x_ddot = free_->acceleration(flow_after);
        return forces_ ? x_ddot + forces_->shift.second(s) - forces_->y_ddot : x_ddot;
    }

    /// The laws of the free ball that slides in this direction, sign of x' - y': y'' = gravity +
    /// friction direction, and the reaction -epsilon friction direction on the oscillator.
    void begin_sliding(int direction) {
        if (p_.has_straight_flights()) return;
        if (!forces_) forces_.emplace();
        Forces& f = *forces_;
        f.rests_inside = false;
        direction_ = p_.friction > 0 ? direction : 0;
        f.y_ddot = p_.gravity + p_.friction * direction_;
        if (p_.load) {
            f.load = p_.load->force(interval_, clock_.tau(), p_.epsilon * p_.lambda);
            f.base = p_.load->base(interval_, clock_.tau());
        }
        Polynomial force = f.load;
        force.add(0, -p_.epsilon * p_.friction * direction_);
        f.shift = response(*free_, force);
    }

    /// The polynomial that load and gravity add to the flow's joint motion of both masses.
    Polynomial joint_shift() const {
        Polynomial force = forces_ ? forces_->load : Polynomial{};
        force.add(0, p_.epsilon * p_.gravity);
        return response(*sticking_, sum({}, force, 1 / (1 + p_.epsilon)));
    }

    void begin_joint_motion() {
        if (!sticking_) sticking_ = Flow::shared_sticking(p_);
        if (p_.has_straight_flights()) return;
        begin_sliding(direction_);
        forces_->shift = joint_shift();
        forces_->rests_inside = side_ == 0;
    }

    double until_next_interval() const {
        return std::max(0.0, clock_.until(p_.load->end_of(interval_)));
    }

    /// The shortest of `rest`, the flow's reach and the time until the load's law changes.
    double until_boundary(double rest, const Flow& flow) const {
        const double limit = std::min(rest, flow.reach());
        if (!p_.load) return limit;
        return std::min({limit, until_next_interval(), p_.load->response_reach(flow.damping())});
    }

    /// Reports a stretch and advances the clock over it. The caller sets the state at its end.
    void pass(const Flow& flow, double duration, int sticking_side) {
        if (duration > 0)
            notify(
                &Observer::on_stretch, {flow, clock_.tau(), duration, of_flow(), y_, y_dot_,
                                        sticking_side, forces_ ? &*forces_ : nullptr});
        clock_.advance(duration);
    }

    void fly() {
        grazing_.clear();
        const FlightStart start = flight();
        // A contact whose tau rounds to tau_end belongs to the run. After it the remaining time can
        // be negative, by half an ulp of tau_end, over which nothing moves.
        const double limit = until_boundary(clock_.until(limits_.tau_end) + end_rounding_, *free_);
        auto contact = fast_contact(*free_, start, p_.b, limit, grazing_);
        // A contact found beyond the end of the sliding would be one of another path.
        std::optional<double> stop;
        if (direction_ != 0)
            stop = next_equal_velocity(
                *free_, start, direction_, slip_zeros_, contact ? contact->s : limit);
        if (stop && contact && *stop < contact->s) contact.reset();
        for (const GrazingPoint& t : grazing_)
            if (!stop || t.s <= *stop) graze(clock_.tau() + t.s, t.side);
        if (stop && !contact) stop_sliding(*stop);
        else fly_to(contact);
    }

    /// Advances past the contact, or over the whole flight without one.
    void fly_to(const std::optional<Contact>& contact) {
        if (contact) {
            pass(*free_, contact->s, 0);
            const double a = relative_acceleration(contact->lo, contact->s);
            lo_ = contact->lo;
            if (forces_) lo_ = with_shift(lo_, contact->s);
            y_ = lo_.x - contact->side * p_.b;
            side_ = contact->side;
            if (contact->relative_speed != 0)
                return forces_ ? strike({contact->s, side_, lo_, contact->relative_speed}, a)
                               : strike(*contact, a);
            // Rounding has reduced the approach speed to zero: a grazing contact.
            graze(clock_.tau(), side_);
            relative_speed_ = 0;
            if (forces_) y_dot_ = lo_.x_dot;
            return leave_or_stick();
        }
        const double rest = clock_.until(limits_.tau_end), limit = until_boundary(rest, *free_);
        const bool ends_interval = p_.load && limit == until_next_interval();
        pass(*free_, limit, 0);
        if (limit == rest) end_ = End::tau_end;
        move_freely(
            limit, limit == free_->reach() ? free_->at(of_flow(), Flow::cells)
                                           : free_->after(of_flow(), std::max(0.0, limit)));
        slip_zeros_ = 0;
        side_ = 0;
        bounce_limit_ -= limit;
        if (!p_.load || end_) return;
        if (ends_interval) ++interval_;
        begin_sliding(direction_);  // the load from here on
    }

    /// Sets the state after a free flight of duration s, given the flow's.
    void move_freely(double s, const Oscillation& flow_after) {
        y_ += s * (y_dot_ + 0.5 * y_ddot() * s);
        y_dot_ += y_ddot() * s;
        lo_ = with_shift(flow_after, s);
    }

    void graze(double tau, int side) {
        ++others_;
        notify(&Observer::on_grazing_contact, tau, side);
    }

    /// x'' - y'' of a joint motion if nothing but friction held the ball.
    double pull_together() const {
        const Polynomial joint = joint_shift();
        const Oscillation o{lo_.x - joint[0], lo_.x_dot - joint[1], lo_.sin_theta, lo_.cos_theta};
        return sticking_->acceleration(o) + joint.second(0) - p_.gravity;
    }

    /// Advances to the moment s at which the sliding ball has the oscillator's velocity, inside the
    /// cavity: friction holds it, or it slides on in the other direction.
    void stop_sliding(double s) {
        const Oscillation end = free_->after(of_flow(), s);
        const double before = relative_acceleration(end, s);
        pass(*free_, s, 0);
        move_freely(s, end);
        y_dot_ = lo_.x_dot;
        relative_speed_ = 0;
        side_ = 0;
        bounce_limit_ -= s;
        begin_sliding(direction_);  // of the load from here on
        if (!sticking_) sticking_ = Flow::shared_sticking(p_);
        const double pull = pull_together();
        if (std::abs(pull) <= p_.friction) {
            notify(&Observer::on_slip, {clock_.tau(), 0});
            return rest_inside();
        }
        begin_sliding(sign_of(pull));
        slip_zeros_ = 1;
        if (s > 0)
            notify(
                &Observer::on_slip, {clock_.tau(), relative_acceleration(of_flow(), 0) / before});
    }

    void strike(const Contact& contact, double relative_acceleration) {
        const Impact i =
            impact_at(p_, contact, relative_acceleration + y_ddot(), clock_.tau(), y_ddot());
        const bool pressed = i.side * relative_acceleration > 0 && contact.s < bounce_limit_;
        chatter_ = i.side == last_side_ && pressed ? chatter_ + 1 : 1;
        last_side_ = i.side;
        ++impacts_;
        // Stored as a whole: a read that spans several separate writes waits for the cache.
        lo_ = {i.x, i.x_dot_after, i.sin_theta, i.cos_theta};
        y_dot_ = i.y_dot_after;
        relative_speed_ = i.relative_speed_after;
        notify(&Observer::on_impact, i);
        leave_or_stick();
    }

    /// At the wall with a relative speed that is zero or points away: sets the leading derivative.
    void leave_or_stick() {
        if (forces_) begin_sliding(relative_speed_ != 0 ? sign_of(relative_speed_) : -side_);
        const Oscillation o = of_flow();
        const double press = side_ * relative_acceleration(o, 0),
                     press_rate = side_ * (free_->jerk(o) + (forces_ ? 6 * forces_->shift[3] : 0));
        bounce_limit_ = press > 0 ? longest_bounce_ : 0;
        if (relative_speed_ != 0) {
            zeros_ = 1;
            slip_zeros_ = 0;
            if (!(press > 0)) return;
            const double R = p_.restitution(side_, std::abs(relative_speed_));
            const double w = std::abs(relative_speed_), rest = rest_of_chatter(w, press, R),
                         drift = std::abs(press_rate) * rest / press;
            const bool is_short = rest < (direction_ == 0 ? chatter_rest : sliding_chatter_rest),
                       is_low = direction_ != 0 && w * w < 2 * press * lowest_height();
            if ((is_short && drift < chatter_drift) ||
                (is_low && drift * rest < sliding_chatter_rest))
                stick(rest, 0);
            // All three zero: both masses stay at rest together.
        } else if (press > 0 || (press == 0 && press_rate >= 0)) {
            stick(0, press == 0);
        } else {
            zeros_ = press < 0 ? 2 : 3;
            slip_zeros_ = zeros_ - 1;
        }
    }

    /// Height of a bounce below which the rounding of positions affects its duration.
    double lowest_height() const {
        return lowest_bounce * std::numeric_limits<double>::epsilon() *
               (std::abs(lo_.x) + std::abs(y_) + p_.b);
    }

    /// Duration of the impacts after one that leaves the ball with the relative speed w, pressed
    /// with the relative acceleration `press`; infinite if they do not end.
    double rest_of_chatter(double w, double press, double R) const {
        // Friction brakes the ball on its way back as well.
        const double press_back = press - 2 * (1 + p_.epsilon) * p_.friction;
        if (!(press_back > 0)) return infinity;
        // Sums of geometric series.
        if (p_.friction == 0) return R < 1 ? 2 * w / (press * (1 - R)) : infinity;
        const double slower = std::sqrt(press_back / press);
        return w / press * (1 + 1 / slower) / (1 - R * slower);
    }

    /// The sticking phase with the rest of the chatter, up to the release. `zeros`: see
    /// next_release().
    void stick(double chatter_left, int zeros) {
        ++others_;
        // The velocity of the centre of mass.
        lo_.x_dot -= p_.epsilon / (1 + p_.epsilon) * relative_speed_;
        notify(
            &Observer::on_stick, {std::min(clock_.tau() + chatter_left, limits_.tau_end), side_,
                                  relative_speed_ == 0 && last_side_ != side_ ? 0 : chatter_});
        relative_speed_ = 0;
        last_side_ = 0;
        y_ = lo_.x - side_ * p_.b;
        follow_joint_motion(zeros);
        begin_sliding(-side_);
        slip_zeros_ = jumps_apart() ? 1 : 2;
        zeros_ = slip_zeros_ + 1;
        notify(&Observer::on_release, clock_.tau());
    }

    /// Friction holds the ball inside the cavity, until it slides again.
    void rest_inside() {
        ++others_;
        side_ = 0;
        bounce_limit_ = 0;  // ends a chatter
        follow_joint_motion(0);
        begin_sliding(sign_of(pull_together()));
        slip_zeros_ = jumps_apart() ? 1 : 2;
    }

    /// Unless the load jumps, the relative acceleration begins at zero after a joint motion.
    bool jumps_apart() const {
        constexpr double rounding = 1e-12;
        if (!p_.load) return false;
        const Oscillation o = of_flow();
        return std::abs(relative_acceleration(o, 0)) >
               rounding * (free_->bounds(o).x_ddot + std::abs(y_ddot()));
    }

    /// Both masses as one, until wall or friction no longer hold the ball.
    void follow_joint_motion(int zeros) {
        begin_joint_motion();
        const double apart = side_ != 0 ? side_ * p_.b : lo_.x - y_;
        for (bool released = false; !released && !end_;) {
            y_ = lo_.x - apart;
            y_dot_ = lo_.x_dot;
            const double rest = clock_.until(limits_.tau_end),
                         limit = until_boundary(rest, *sticking_);
            const bool ends_interval = p_.load && limit == until_next_interval();
            const Polynomial shift = forces_ ? forces_->shift : Polynomial{},
                             pull = sum({p_.gravity}, shift.derivative().derivative(), -1);
            std::optional<double> release;
            for (const int held_by : {1, -1})
                if (held_by == side_ || side_ == 0) {
                    const auto end = next_release(
                        *sticking_, of_flow(), held_by, zeros, release.value_or(limit), pull,
                        -p_.friction);
                    if (end) release = end;
                }
            const double s = release ? *release : limit;
            pass(*sticking_, s, side_);
            lo_ = with_shift(sticking_->after(of_flow(), std::max(0.0, s)), s);
            released = release.has_value();
            zeros = 0;
            if (!released && ends_interval) ++interval_;
            if (p_.load) begin_joint_motion();
            if (!released && limit == rest) end_ = End::tau_end;
            if (!released && limits_.stop && limits_.stop()) end_ = End::stopped;
        }
        y_ = lo_.x - apart;
        y_dot_ = lo_.x_dot;
    }

    const Parameters& p_;
    const Limits& limits_;
    const std::span<Observer* const> observers_;
    const std::shared_ptr<const Flow> free_ = Flow::shared_free(p_);
    std::shared_ptr<const Flow> sticking_;  // set at the first sticking phase
    Clock clock_;
    Oscillation lo_;
    double y_, y_dot_;
    const double end_rounding_ = 0.5 * (limits_.tau_end - std::nextafter(limits_.tau_end, 0));
    int side_;                      // the wall that the ball is at, 0 in flight
    double relative_speed_;         // x' - y' at that wall
    int zeros_ = 1;                 // see FlightStart
    int direction_ = 0;             // sign of x' - y' of a sliding ball; 0 without friction
    int slip_zeros_ = 0;            // see next_equal_velocity()
    std::optional<Forces> forces_;  // empty if they are the paper's
    std::size_t interval_ = 0;      // of the load
    // Side and length of the current sequence of impacts on one side, joined by the pressing wall.
    int last_side_ = 0, chatter_ = 0;
    // A flight that leaves a pressing wall and returns to it while it presses, within half a cycle
    // of the faster of forcing and oscillator, was pressed throughout and belongs to a chatter.
    // `bounce_limit_`: longest duration for which the current flight does.
    const double longest_bounce_ = p_.faster_half_cycle();
    double bounce_limit_ = 0;
    std::vector<GrazingPoint> grazing_;  // of the current flight
    long impacts_ = 0, others_ = 0;      // others: sticking phases and grazing contacts
    long until_look_ = 0;                // flights, and events that end them, to the next look
    std::optional<End> end_;
};

}  // namespace

Outcome simulate(
    const Parameters& parameters, const State& start, const Limits& limits,
    std::span<Observer* const> observers) {
    return Run(parameters, start, limits, observers).run_to_end();
}

}  // namespace vines
