#include "core/motion/run.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/motion/simulate.hpp"

namespace vines {

namespace {

// A chatter ends when its remaining duration is below this: the remaining impacts, of which there
// are infinitely many, then differ from their limit by less than the accuracy of any result. The
// relative speed is near 1e-12 of a typical one, far above the effect of rounding
// (contact_search.hpp, rule 3).
constexpr double chatter_rest = 1e-9;
// The remaining duration is the sum of a geometric series for a constant acceleration, which
// changes by less than this fraction.
constexpr double chatter_drift = 1e-4;

// Events between two calls of the stop function; a flight without a contact in its reach is one.
constexpr long events_per_look = 64;

}  // namespace

Run::Run(
    const Parameters& p, const State& start, const Limits& limits,
    std::span<Observer* const> observers)
    : p_(p),
      limits_(limits),
      observers_(observers),
      free_table_(Flow::shared_free(p)),
      free_(*free_table_),
      clock_(limits.tau_start),
      y_(start.y),
      y_dot_(start.y_dot),
      longest_bounce_(p.faster_half_cycle()) {
    const double theta = p.Omega * limits.tau_start + p.phi();
    lo_ = {start.x, start.x_dot, elementary::sin(theta), elementary::cos(theta)};
    side_ = wall_of(start, p.b);
    end_rounding_ = 0.5 * (limits.tau_end - std::nextafter(limits.tau_end, 0));
    relative_speed_ = start.x_dot - start.y_dot;
    assert(is_physical(p));
    assert(std::abs(start.x - start.y) <= p.b + position_rounding(free_.bounds(lo_), start.y, p.b));
    if (side_ != 0) meet_wall_at_start();
}

Outcome Run::run_to_end() {
    while (!is_over()) fly();
    return outcome();
}

bool Run::is_over() {
    if (!end_ && std::max(impacts_, others_) >= limits_.max_impacts) end_ = End::max_impacts;
    if (!end_ && limits_.stop && events_++ % events_per_look == 0 && limits_.stop())
        end_ = End::stopped;
    return end_.has_value();
}

Outcome Run::outcome() const {
    return {*end_, clock_.tau(), {lo_.x_dot, lo_.x, y_dot_, y_}, impacts_};
}

/// Reports a stretch to the observers and advances the clock over it. The caller sets the state at
/// its end.
void Run::pass(const Flow& flow, double duration, int sticking_side, const Transfer* over) {
    if (duration > 0)
        notify(
            &Observer::on_stretch,
            {flow, clock_.tau(), duration, lo_, y_, y_dot_, sticking_side, over});
    clock_.advance(duration);
}

void Run::meet_wall_at_start() {
    y_ = lo_.x - side_ * p_.b;
    if (side_ * relative_speed_ > 0) strike({0, side_, lo_, relative_speed_});
    else leave_or_stick();
}

// A contact whose tau rounds to tau_end belongs to the run. After it the remaining time can be
// negative, by half an ulp of tau_end, over which nothing moves.
double Run::flight_limit() const {
    return std::min(clock_.until(limits_.tau_end) + end_rounding_, free_.reach());
}

void Run::fly() {
    grazing_.clear();
    const auto contact = fast_contact(free_, flight(), p_.b, flight_limit(), grazing_);
    for (const GrazingPoint& t : grazing_) graze(clock_.tau() + t.s, t.side);
    fly_to(contact, nullptr);
}

void Run::fly_to(const std::optional<Contact>& contact, const Transfer* over) {
    const double rest = clock_.until(limits_.tau_end), limit = std::min(rest, free_.reach());
    pass(free_, contact ? contact->s : limit, 0, over);
    if (contact) {
        lo_ = contact->lo;
        y_ = lo_.x - contact->side * p_.b;
        side_ = contact->side;
        if (contact->relative_speed != 0) return strike(*contact);
        // Rounding has reduced the approach speed to zero: a grazing contact.
        graze(clock_.tau(), side_);
        relative_speed_ = 0;
        return leave_or_stick();
    }
    if (limit == rest) end_ = End::tau_end;
    y_ += y_dot_ * limit;
    lo_ = limit == free_.reach() ? free_.at(lo_, Flow::cells)
                                 : free_.after(lo_, std::max(0.0, limit));
    side_ = 0;
    bounce_limit_ = 0;
}

void Run::graze(double tau, int side) {
    ++others_;
    notify(&Observer::on_grazing_contact, tau, side);
}

void Run::strike(const Contact& contact) {
    const Impact i = impact_at(p_, contact, free_.acceleration(contact.lo), clock_.tau());
    const bool pressed = i.side * i.x_ddot_before > 0 && contact.s < bounce_limit_;
    chatter_ = i.side == last_side_ && pressed ? chatter_ + 1 : 1;
    last_side_ = i.side;
    ++impacts_;
    lo_.x_dot = i.x_dot_after;
    y_dot_ = i.y_dot_after;
    relative_speed_ = i.relative_speed_after;
    notify(&Observer::on_impact, i);
    leave_or_stick();
}

/// At the wall side_ with a relative speed that is zero or points away from it: determines the
/// leading derivative of the gap.
void Run::leave_or_stick() {
    const double press = side_ * free_.acceleration(lo_), press_rate = side_ * free_.jerk(lo_);
    bounce_limit_ = press > 0 ? longest_bounce_ : 0;
    if (relative_speed_ != 0) {
        zeros_ = 1;
        const double R = p_.restitution(side_, std::abs(relative_speed_));
        // Sum of the geometric series of 2 w/press.
        const double rest = 2 * std::abs(relative_speed_) / (press * (1 - R));
        if (press > 0 && R < 1 && rest < chatter_rest &&
            std::abs(press_rate) * rest < chatter_drift * press)
            stick(rest, 0);
        // All three zero: both masses stay at rest together.
    } else if (press > 0 || (press == 0 && press_rate >= 0)) {
        stick(0, press == 0);
    } else {
        zeros_ = press < 0 ? 2 : 3;
    }
}

/// The sticking phase up to the release. The rest of the chatter counts as part of it: the centre
/// of mass obeys the same law. `zeros` as in next_release().
void Run::stick(double chatter_left, int zeros) {
    ++others_;
    if (!sticking_) sticking_ = Flow::shared_sticking(p_);
    // The velocity of the centre of mass.
    lo_.x_dot -= p_.epsilon / (1 + p_.epsilon) * relative_speed_;
    notify(
        &Observer::on_stick, {std::min(clock_.tau() + chatter_left, limits_.tau_end), side_,
                              relative_speed_ == 0 && last_side_ != side_ ? 0 : chatter_});
    relative_speed_ = 0;
    last_side_ = 0;
    for (bool released = false; !released && !end_;) {
        y_ = lo_.x - side_ * p_.b;
        y_dot_ = lo_.x_dot;
        const double rest = clock_.until(limits_.tau_end),
                     limit = std::min(rest, sticking_->reach());
        const auto release = next_release(*sticking_, lo_, side_, zeros, limit);
        const double s = release ? *release : limit;
        pass(*sticking_, s, side_, nullptr);
        lo_ = sticking_->after(lo_, std::max(0.0, s));
        released = release.has_value();
        zeros = 0;
        if (!released && limit == rest) end_ = End::tau_end;
        if (!released && limits_.stop && limits_.stop()) end_ = End::stopped;
    }
    y_ = lo_.x - side_ * p_.b;
    y_dot_ = lo_.x_dot;
    zeros_ = 3;  // x'' = 0 at the release as well
    notify(&Observer::on_release, clock_.tau());
}

Outcome simulate(
    const Parameters& parameters, const State& start, const Limits& limits,
    std::span<Observer* const> observers) {
    return Run(parameters, start, limits, observers).run_to_end();
}

Outcome simulate(const RunPlan& plan) {
    return simulate(plan.parameters, plan.start, plan.limits, plan.observers);
}

}  // namespace vines
