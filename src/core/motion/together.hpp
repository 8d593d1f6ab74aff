// Runs side by side on one thread: while each of them flies, the contacts of all are searched for
// in the lanes of vector instructions.
//
// A run's flights are those that it has alone, bit for bit (flight_lanes.hpp). What is no plain
// flight (a chatter's hop, a stuck phase, a doubtful cell) a run does by itself, and when it ends,
// the next one of its line takes its place: no lane waits for another one. Lanes share one flow,
// whose tables they read: runs of another one than the first's fly alone.
#pragma once

#include <vector>

#include "core/motion/flight_lanes.hpp"
#include "core/motion/simulate.hpp"

namespace vines {

/// Runs that follow each other.
class RunLine {
public:
    virtual ~RunLine() = default;
    /// The next one, or none: the line has ended. `last`: how the one before it ended, none at
    /// first. What it throws ends the work of all lines.
    virtual std::optional<RunPlan> next(const std::optional<Outcome>& last) = 0;
};

/// Up to as many lines as fill the lanes.
inline constexpr int most_lines = FlightLanes::lanes;
void simulate_together(std::span<RunLine* const> lines);
/// The same by one of the searches; none: each flight alone.
void simulate_together(std::span<RunLine* const> lines, FlightSearch search);

}  // namespace vines
