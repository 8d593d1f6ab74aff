// A run, flight by flight: what moves, and what is told to the observers.
#pragma once

#include <memory>
#include <optional>
#include <type_traits>
#include <vector>

#include "core/motion/simulate.hpp"

namespace vines {

/// Time as a sum of two doubles, so that adding a million small steps loses nothing.
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

/// Parameters, limits and observers outlive it.
class Run {
public:
    Run(const Parameters& parameters, const State& start, const Limits& limits,
        std::span<Observer* const> observers);

    /// From flight to flight, until it is over.
    Outcome to_its_end();

    // Or step by step. Asked before each flight: the last one may have reached a limit.
    bool is_over();
    Outcome outcome() const;

    // The flight that is next, and how far to look for the contact that ends it.
    const Flow& flow() const { return free_; }
    double b() const { return p_.b; }
    FlightStart flight() const { return {lo_, y_, y_dot_, side_, relative_speed_, zeros_}; }
    double flight_limit() const;
    /// Finds that contact, and goes on to the flight behind it.
    void fly();
    /// Goes on by the one that was found: fast_contact() of this flight, without a touch before it.
    /// `over`: the flight's transfer matrix, where it is known already; else null.
    void fly_to(const std::optional<Contact>& contact, const Transfer* over);
    bool is_observed() const { return !observers_.empty(); }

private:
    template <class... Arguments>
    void tell(void (Observer::*event)(Arguments...), std::type_identity_t<Arguments>... arguments) {
        for (Observer* o : observers_) (o->*event)(arguments...);
    }
    void pass(const Flow& flow, double duration, int stuck_side, const Transfer* over);
    void meet_wall_at_start();
    void touch(double tau, int side);
    void strike(const Contact& contact);
    void leave_or_stick();
    void stick(double chatter_left, int zeros);

    const Parameters& p_;
    const Limits& limits_;
    std::span<Observer* const> observers_;
    const std::shared_ptr<const Flow> free_table_;
    const Flow& free_;
    std::shared_ptr<const Flow> stuck_;  // from the first stick on
    Clock clock_;
    Oscillation lo_;
    double y_, y_dot_;
    double end_rounding_;
    int side_ = 0;               // the wall that the mass is at, 0 in flight
    double relative_speed_ = 0;  // x' - y' at that wall
    int zeros_ = 1;              // see FlightStart
    // Side and length of the current run of impacts on one side that its wall's pressing joins.
    int last_side_ = 0, chatter_ = 0;
    // A flight that leaves a pressing wall and comes back to it while it presses, within half a
    // cycle of the faster of forcing and oscillator, was pressed all along: it belongs to a
    // chatter. `hop_`: how long the one at hand may last for that.
    const double longest_hop_;
    double hop_ = 0;
    std::vector<Touch> touches_;     // of the flight at hand
    long impacts_ = 0, others_ = 0;  // others: sticks and touches
    long events_ = 0;                // flights and what ends them
    std::optional<End> end_;
};

}  // namespace vines
