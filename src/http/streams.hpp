// The lines of sweeps, continuations and designs, which are sent while they are computed. They take
// compute slots as background work, and stop when their client leaves.
#pragma once

#include "api/continuation.hpp"
#include "api/design.hpp"
#include "api/format/sweep_table.hpp"
#include "http/routes.hpp"

namespace vines::http {

/// A sweep as a stream of NDJSON lines, or as a table. It ends after the sweep deadline: lines with
/// the points so far, a table with a reset connection. Problem 413 for a table beyond the answer
/// limit; 503 if the maximum number of sweeps is running. The admission control and the metrics of
/// the service must outlive the response.
Response stream_sweep(
    api::SweepRequest request, api::Format format, const Request& asked, const Service& service);

/// The branches of a continuation, or the absorbers of a design, as a stream of NDJSON lines, which
/// counts as a sweep: the same slots, deadline and refusals.
Response stream_continuation(
    api::ContinueRequest request, const Request& asked, const Service& service);
Response stream_design(api::DesignRequest request, const Request& asked, const Service& service);

}  // namespace vines::http
