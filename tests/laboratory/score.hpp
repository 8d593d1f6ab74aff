// An identification held against the truth.
#pragma once

#include "../core/measurement/laboratory.hpp"
#include "core/measurement/measurement.hpp"

namespace vines::test {

struct Score {
    long impacts = 0;             ///< true ones
    long found = 0, flipped = 0;  ///< of them; at the other wall
    long false_ones = 0;          ///< that are none
    double R_error = 0;           ///< the larger of both walls
    double b_error = 0;           ///< relative; NaN where none is fitted
    double lambda1_error = 0;     ///< relative to the true one
    double within_100_us = 0;     ///< share of the found ones
    Verdict verdict = Verdict::not_decided;
    bool verdict_wrong = false;
    double seconds = 0;  ///< that it took

    /// At least 99 % found, at most one false, R within .003, lambda1 within 5 % of it or .002 (of
    /// a regular motion it is small), no wrong verdict.
    bool is_right() const;
};

/// Identifies, and compares. An impact is found where one that is not left out lies within 1.5 ms
/// of it; a constant delay of the pulses counts as none.
Score score_of(const Experiment& experiment);
Score score_of(const Experiment& experiment, const MeasurementResult& result);

}  // namespace vines::test
