// What the product says of a run, through its two doors: a sweep's point and the answer to a
// simulation.
#pragma once

#include <optional>
#include <string>

#include "core/sweep/sweep.hpp"
#include "systems.hpp"

namespace vines::hunt {

struct Statement {
    std::string door;  ///< which door it comes through
    State start;       ///< of the measured run
    int cycles;        ///< measured
    bool complete;     ///< it ran to its end
    Verdict verdict;
    double lambda1, error;
    bool periodic;
    int period;  ///< in cycles, with what follows where periodic
    bool symmetric;
    std::optional<double> captured_at;  ///< in cycles; none: not yet
    bool chaotic_before;
    std::string type;
    std::string request;  ///< that repeats it
};

/// measure(), as a sweep does with each of its points.
Statement sweep_point(const System& system, int transient, int cycles);

/// The answer to a request for a run of so many cycles.
Statement simulation(const System& system, int cycles);

}  // namespace vines::hunt
