// Impact lists that are generated while an answer is sent.
//
// An answer can list more impacts than are kept in memory. Its part `impacts` then holds a
// placeholder for each column. While the answer is written, the run is repeated, which yields the
// same bits, for a few columns at a time.
#pragma once

#include <optional>

#include "api/cancellation.hpp"
#include "api/columns.hpp"
#include "api/json_text.hpp"
#include "core/analysis/analysis.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

/// A run and the range of its listed impacts.
struct ListedRun {
    AnalysisRequest wanted;
    ImpactRange listed;
    ImpactScales scales;
};

/// The columns of describe_impacts() and their SI counterparts as placeholders.
Json streamed_impacts(const std::optional<SiParameters>& si);

/// A function for JsonText that generates the placeholder lists of `answer`, in their order. Each
/// repetition of the run fills as many columns as fit into `most_bytes`, at least one, between
/// control.begin() and control.end(). The function throws Cancelled if `control` stops a run.
JsonText::ListOf list_generator(
    const ListedRun& run, const Json& answer, RunControl& control, std::size_t most_bytes);

}  // namespace vines::api
