// Comparison of a result with a long run of the same motion.
#pragma once

#include <string>
#include <vector>

#include "long_run.hpp"
#include "section_curve.hpp"
#include "statement.hpp"

namespace vines::hunt {

struct Judgement {
    /// Confident results that the long run contradicts, as sentences.
    std::vector<std::string> wrong;
    /// Period, up to 64 cycles, with which the run returns at its end; 0: none.
    int recurrent = 0;
    bool missed = false;  ///< `recurrent` was not found
    /// The long run lies on a torus, which was reached during the run under test; the statement
    /// does not report it.
    bool torus = false, torus_missed = false;
    /// Chaos before the capture, by the long run; the statement does not report it.
    bool transient = false, transient_missed = false;
};

/// `curve`: section_curve() of the long run's end, if torus_possible().
Judgement judge(
    const Parameters& parameters, const Statement& statement, const LongRun& run,
    const std::optional<SectionCurve>& curve);

/// True if the end of a long run neither returns nor is irregular nor approaches an orbit.
bool torus_possible(const LongRun& run);

/// Contradictions among the results of successively longer runs from the same start.
std::vector<std::string> contradictions(
    const std::vector<Statement>& increasing_length, const LongRun& run);

}  // namespace vines::hunt
