// What the service answers to which path.
#pragma once

#include <string>
#include <vector>

#include "api/simulate.hpp"
#include "http/compute_gate.hpp"
#include "http/metrics.hpp"
#include "http/page.hpp"
#include "http/route.hpp"

namespace vines::http {

struct RouteOptions {
    double deadline = 30;                  ///< seconds of computing for one request
    double sweep_deadline = 3600;          ///< seconds of one sweep's stream
    std::size_t sweep_points = 100000;     ///< of one sweep, at most
    std::size_t record_limit = 64 << 20;   ///< bytes of a measurement sent to /v1/identify
    std::size_t answer_limit = 128 << 20;  ///< bytes of an answer's JSON
    /// More listed impacts than this leave as a stream, with columns that are made meanwhile.
    std::size_t most_kept_impacts = api::most_kept_impacts;
    PageOptions page = {};
};

/// All routes. `gate` and `metrics` outlive them. Throws std::runtime_error where the page's folder
/// cannot be read.
std::vector<Route> make_routes(const RouteOptions& options, ComputeGate& gate, Metrics& metrics);

}  // namespace vines::http
