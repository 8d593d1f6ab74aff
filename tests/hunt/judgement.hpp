// A statement held against the long run of the same motion.
#pragma once

#include <string>
#include <vector>

#include "long_run.hpp"
#include "statement.hpp"

namespace vines::hunt {

struct Judgement {
    /// Sentences on what is said with confidence and does not hold.
    std::vector<std::string> wrong;
    /// The period, of up to 64 cycles, that the run itself returns with at its end.
    int recurrent = 0;
    bool missed = false;  ///< and which was not found
};

Judgement judge(const Parameters& parameters, const Statement& statement, const LongRun& run);

/// What contradicts itself among statements on longer and longer runs from the same start.
std::vector<std::string> contradictions(
    const std::vector<Statement>& longer_and_longer, const LongRun& run);

}  // namespace vines::hunt
