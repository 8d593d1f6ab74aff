// The lines of sweeps, continuations and designs, which are sent while they are computed. They take
// compute slots as background work, and stop when their client leaves.
#pragma once

#include "api/format/sweep_table.hpp"
#include "http/routes.hpp"

namespace vines::http {

/// Sends a computation, which counts as a sweep, or, if is_shared, the lines of a running one of an
/// equal request. It ends after the sweep deadline: lines with an error, a table with a reset
/// connection. Problem 503 if the maximum number of sweeps is running. The service must outlive the
/// response, which can be copied: the sweep's slot is released with the last copy, whether it was
/// sent or not.
Response stream_lines(
    std::shared_ptr<api::LineStream> stream, const Request& asked, const Service& service,
    bool is_shared = false);

/// A sweep as NDJSON lines, or as a table; problem 413 for a table beyond the answer limit. A small
/// sweep of lines is computed once for all equal requests that come while it runs.
Response stream_sweep(
    api::SweepRequest request, api::Format format, const Request& asked, const Service& service);

}  // namespace vines::http
