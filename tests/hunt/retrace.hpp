// Events of a run recomputed in 100 digits. The run in double precision only gives the sequence of
// events and their approximate times.
#pragma once

#include <vector>

#include "core/motion/simulate.hpp"
#include "tangent.hpp"

namespace vines::hunt {

using Precise = Decimal<100>;

/// An event of a run, in order of time.
struct Event {
    enum Kind { impact, stick, release } kind;
    double tau;
    int side;
};

class EventRecord : public Observer {
public:
    void on_impact(const Impact& i) override { events.push_back({Event::impact, i.tau, i.side}); }
    void on_stick(const StickStart& s) override { events.push_back({Event::stick, s.tau, s.side}); }
    void on_release(double tau) override {
        events.push_back({Event::release, tau, events.back().side});
    }

    std::vector<Event> events;
};

/// An event with the data of its transfer matrix.
struct PreciseEvent {
    Event::Kind kind;
    Precise since;                 ///< time since the previous event, or since tau = 0
    Collision<Precise> collision;  ///< for an impact
};

struct Retraced {
    std::vector<PreciseEvent> events;
    double departure;  ///< largest |tau - tau in double precision|
};

Retraced retrace(
    const Parameters& parameters, const State& start, const std::vector<Event>& events);

}  // namespace vines::hunt
