// Comparison of an identification with the truth.
#pragma once

#include "../core/measurement/laboratory.hpp"
#include "core/measurement/measurement.hpp"

namespace vines::test {

struct Score {
    long impacts = 0;             ///< true impacts
    long found = 0, flipped = 0;  ///< of these; found at the wrong wall
    long false_ones = 0;          ///< detected, but not true
    double R_error = 0;           ///< maximum of both walls
    double b_error = 0;           ///< relative; NaN if b is not fitted
    double lambda1_error = 0;     ///< relative to the true one
    double within_100_us = 0;     ///< fraction of the found impacts
    Verdict verdict = Verdict::not_decided;
    bool verdict_wrong = false;
    double seconds = 0;  ///< computing time

    /// At least 99 % found, at most one false, R within .003, lambda1 within 5 % or .002 (regular
    /// motions have a small one), no wrong verdict.
    bool is_right() const;
};

/// Identifies and compares. A true impact is found if an impact that is not excluded lies within
/// 1.5 ms of it; a constant delay of the pulses is not counted as an error.
Score score_of(const Experiment& experiment);
Score score_of(const Experiment& experiment, const MeasurementResult& result);

}  // namespace vines::test
