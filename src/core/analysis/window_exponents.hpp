// The exponents of one window of a run, and what they say.
#pragma once

#include <vector>

#include "core/analysis/warning.hpp"
#include "core/measures/regime.hpp"

namespace vines {

/// coarse_slope() of each estimator; NaN without it, or of too few impacts.
struct ExponentSlopes {
    double qr, eigenvalues, raw_product;
};

struct WindowExponents {
    Interval asked;
    TransferProduct product;  ///< of the estimators that were asked for
    Growth growth;            ///< by qr; NaN without it
    ExponentSlopes slopes;
    Judgement judgement;
};

/// `growth`: of the product; `regime`: of the run.
WindowExponents window_exponents(
    const Interval& asked, TransferProduct&& product, const Growth& growth, const Regime& regime);

/// What is worth a warning where the histories are shown as well: all; else the sum rule alone.
void add_warnings(
    const TransferProduct& product, const ExponentOptions& shown, bool histories,
    std::vector<Warning>& warnings);

}  // namespace vines
