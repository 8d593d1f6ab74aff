// Exponents and their verdict as parts of an answer: null where there is no number, with a word
// beside it that says why.
#pragma once

#include "api/schema/json.hpp"
#include "core/analysis/window_exponents.hpp"

namespace vines::api {

/// {final, status}: the four, per unit of tau.
Json describe_final(const Exponents& values);

/// The exponents of one window of a run of this regime, with the verdict, by the estimators that
/// are to be shown. `histories`: those of each estimator, too.
Json describe_exponents(
    const WindowExponents& window, const ExponentOptions& shown, const Regime& regime,
    bool histories);
/// Its parts: how long the window is, and what each estimator says.
Json describe_window(const TransferProduct& product);
void add_estimators(
    Json& part, const TransferProduct& product, const Growth& growth, const ExponentOptions& shown,
    bool histories);

}  // namespace vines::api
