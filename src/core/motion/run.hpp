// A run, flight by flight: state of the motion and notification of the observers.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "core/motion/simulate.hpp"

namespace vines {

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
    Run(const Parameters& parameters, const State& start, const Limits& limits,
        std::span<Observer* const> observers);

    Outcome run_to_end();

private:
    bool is_over();
    FlightStart flight() const {
        if (!forces_) return {lo_, y_, y_dot_, side_, relative_speed_, zeros_};
        const Polynomial& p = forces_->shift;
        return {of_flow(),       y_ - p[0], y_dot_ - p[1],         side_,
                relative_speed_, zeros_,    0.5 * forces_->y_ddot, p.size > 2 ? &p : nullptr};
    }
    double flight_limit() const;
    void fly();
    void fly_to(const std::optional<Contact>& contact);
    template <class... Arguments>
    void notify(
        void (Observer::*event)(Arguments...), std::type_identity_t<Arguments>... arguments) {
        for (Observer* o : observers_) (o->*event)(arguments...);
    }
    void pass(const Flow& flow, double duration, int sticking_side);
    void meet_wall_at_start();
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
        const double x_ddot = free_.acceleration(flow_after);
        return forces_ ? x_ddot + forces_->shift.second(s) - forces_->y_ddot : x_ddot;
    }
    void begin_sliding(int direction);
    void begin_joint_motion();
    Polynomial joint_shift() const;
    double until_next_interval() const;  ///< of the load
    double until_boundary(double rest, const Flow& flow) const;
    void move_freely(double s, const Oscillation& flow_after);
    void stop_sliding(double s);
    double pull_together() const;
    bool jumps_apart() const;
    void rest_inside();
    void follow_joint_motion(int zeros);
    void graze(double tau, int side);
    void strike(const Contact& contact, double relative_acceleration);
    void leave_or_stick();
    double rest_of_chatter(double w, double press, double R) const;
    void stick(double chatter_left, int zeros);

    const Parameters& p_;
    const Limits& limits_;
    std::span<Observer* const> observers_;
    const std::shared_ptr<const Flow> free_table_;
    const Flow& free_;
    std::shared_ptr<const Flow> sticking_;  // set at the first sticking phase
    Clock clock_;
    Oscillation lo_;
    double y_, y_dot_;
    double end_rounding_;
    int side_ = 0;                  // the wall that the ball is at, 0 in flight
    double relative_speed_ = 0;     // x' - y' at that wall
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
    const double longest_bounce_;
    double bounce_limit_ = 0;
    std::vector<GrazingPoint> grazing_;  // of the current flight
    long impacts_ = 0, others_ = 0;      // others: sticking phases and grazing contacts
    long events_ = 0;                    // flights and the events that end them
    std::optional<End> end_;
};

}  // namespace vines
