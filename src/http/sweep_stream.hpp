// A sweep as a stream of NDJSON lines, computed behind a gate and stopped when its client leaves.
#pragma once

#include <string>

#include "api/sweep.hpp"
#include "http/compute_gate.hpp"
#include "http/message.hpp"
#include "http/metrics.hpp"

namespace vines::http {

/// Answers a sweep, which ends after so many seconds with the points that it has; 503 where the
/// gate has no room for one more. The gate and the metrics outlive the response.
Response stream_sweep(
    api::SweepRequest request, double deadline, const std::string& request_id, ComputeGate& gate,
    Metrics& metrics);

}  // namespace vines::http
