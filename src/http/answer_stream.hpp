// An answer that is written while its longest lists are made, behind a gate, and broken off when
// its client leaves.
#pragma once

#include <string>

#include "api/simulate.hpp"
#include "http/compute_gate.hpp"
#include "http/message.hpp"

namespace vines::http {

/// The gate outlives the response.
Response stream_answer(api::Answer answer, const std::string& request_id, ComputeGate& gate);

}  // namespace vines::http
