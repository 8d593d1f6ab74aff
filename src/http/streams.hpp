// Answers that are computed while they are sent: the long lists of a simulation, and the lines of a
// sweep. They take compute slots as background work, and stop when their client leaves.
#pragma once

#include <string>

#include "api/simulate.hpp"
#include "api/sweep.hpp"
#include "http/admission_control.hpp"
#include "http/message.hpp"
#include "http/metrics.hpp"

namespace vines::http {

/// Sends an answer whose lists of impacts are computed meanwhile; `admission` must outlive it.
Response stream_answer(
    api::Answer answer, const std::string& request_id, AdmissionControl& admission);

/// A sweep as a stream of NDJSON lines. It ends after `deadline` seconds with the points it has.
/// 503 if the maximum number of sweeps is running. `admission` and `metrics` must outlive the
/// response.
Response stream_sweep(
    api::SweepRequest request, double deadline, const std::string& request_id,
    AdmissionControl& admission, Metrics& metrics);

}  // namespace vines::http
