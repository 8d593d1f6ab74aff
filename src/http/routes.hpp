// What the service answers to which path.
#pragma once

#include <string>
#include <vector>

#include "http/compute_gate.hpp"
#include "http/message.hpp"

namespace vines::http {

struct RouteOptions {
    double deadline;           ///< seconds of computing for one request
    std::size_t sweep_points;  ///< of one sweep, at most
    std::size_t record_limit;  ///< bytes of a measurement sent to /v1/identify
    std::size_t answer_limit;  ///< bytes of an answer's JSON
    /// Serve the page from this folder instead of the program; empty: do not.
    std::string web_dir;
};

/// All routes. `gate` outlives them.
std::vector<Route> make_routes(const RouteOptions& options, ComputeGate& gate);

/// A problem document as a response.
Response problem_response(int status, const std::string& detail);

}  // namespace vines::http
