// The lines of sweeps, continuations and designs, which are sent while they are computed. They take
// compute slots as background work, and stop when their client leaves.
#pragma once

#include "api/continuation.hpp"
#include "api/design.hpp"
#include "api/format/sweep_table.hpp"
#include "api/sweep.hpp"
#include "http/admission_control.hpp"
#include "http/message.hpp"
#include "http/metrics.hpp"

namespace vines::http {

/// The format of a sweep, and the largest table in CBOR or npz, bytes.
struct SweepForm {
    api::Format format;
    std::size_t most_bytes;
};

/// A sweep as a stream of NDJSON lines, or as a table. It ends after `deadline` seconds: a stream
/// of lines with the points it has, a table without its end and with a reset connection. Problem
/// 413 for a table that is too large; 503 if the maximum number of sweeps is running. `admission`
/// and `metrics` must outlive the response.
Response stream_sweep(
    api::SweepRequest request, SweepForm form, double deadline, const Request& asked,
    AdmissionControl& admission, Metrics& metrics);

/// The branches of a continuation, or the absorbers of a design, as a stream of NDJSON lines, which
/// counts as a sweep: the same slots, deadline and refusals.
Response stream_continuation(
    api::ContinueRequest request, double deadline, const Request& asked,
    AdmissionControl& admission, Metrics& metrics);
Response stream_design(
    api::DesignRequest request, double deadline, const Request& asked, AdmissionControl& admission,
    Metrics& metrics);

}  // namespace vines::http
