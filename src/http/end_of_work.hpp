// When the work for a request ends before its own end: it takes too long, its client has left, or
// the server is about to end.
#pragma once

#include "api/simulate.hpp"
#include "http/compute_gate.hpp"
#include "http/message.hpp"
#include "http/turn.hpp"

namespace vines::http {

/// Ends what takes longer than so many seconds from now on, without those in which its turn waits,
/// or is not needed any more. The gate and the turn outlive it. Asked by one thread at a time.
api::Stop end_of_work(double seconds, const Request& request, const ComputeGate& gate, Turn& turn);

}  // namespace vines::http
