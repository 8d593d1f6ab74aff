// Comparison of a result with a long run of the same motion.
#pragma once

#include <string>
#include <vector>

#include "long_run.hpp"
#include "statement.hpp"

namespace vines::hunt {

struct Judgement {
    /// Confident results that the long run contradicts, as sentences.
    std::vector<std::string> wrong;
    /// Period, up to 64 cycles, with which the run returns at its end; 0: none.
    int recurrent = 0;
    bool missed = false;  ///< `recurrent` was not found
};

Judgement judge(const Parameters& parameters, const Statement& statement, const LongRun& run);

/// Contradictions among the results of successively longer runs from the same start.
std::vector<std::string> contradictions(
    const std::vector<Statement>& increasing_length, const LongRun& run);

}  // namespace vines::hunt
