// When the work for a request ends before its own end: it takes too long, its client has left, or
// the server is about to end.
#pragma once

#include "api/simulate.hpp"
#include "http/compute_gate.hpp"
#include "http/message.hpp"

namespace vines::http {

/// Ends what takes longer than so many seconds from now on, or is not needed any more. The gate
/// outlives it. Asked by one thread at a time.
api::Stop end_of_work(double seconds, const Request& request, const ComputeGate& gate);

}  // namespace vines::http
