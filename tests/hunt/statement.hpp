// Results of the product for a run, from its two interfaces: a sweep's point and the answer to a
// simulation.
#pragma once

#include <optional>
#include <string>

#include "core/sweep/sweep.hpp"
#include "systems.hpp"

namespace vines::hunt {

struct Statement {
    std::string interface;  ///< interface and length of the run, for messages
    State start;            ///< of the measured run
    int cycles;             ///< number of measured cycles
    bool complete;          ///< the run reached its end
    Verdict verdict;
    double lambda1, error;
    bool periodic;
    int period;  ///< in cycles; valid, with `symmetric`, if periodic
    bool symmetric;
    std::optional<double> captured_at;  ///< in cycles; empty: not captured
    bool chaotic_before;                ///< chaos before the capture is reported
    bool covers_start;                  ///< the verdict is on the whole run, not on its end alone
    struct QuasiPeriodic {
        double rotation_number, error;
        int curves;
    };
    std::optional<QuasiPeriodic> quasi_periodic;
    std::string type;
    std::string request;  ///< reproduces the run
};

/// Result of measure(), as for a sweep's point.
Statement sweep_point(const System& system, int transient, int cycles);

/// Answer to a simulation request over this number of cycles.
Statement simulation(const System& system, int cycles);

}  // namespace vines::hunt
