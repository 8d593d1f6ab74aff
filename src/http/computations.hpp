// The answers of the routes that compute.
#pragma once

#include "http/routes.hpp"
#include "http/stopwatch.hpp"

namespace vines::http {

/// What a computation is made with.
struct Service {
    const RouteOptions options;
    ComputeGate& gate;
    Metrics& metrics;
};

// Each throws a Problem that is its answer, and tells the watch what it has done.

Response simulate(const Request& request, const Service& service, Stopwatch& watch);
Response manifold(const Request& request, const Service& service, Stopwatch& watch);
Response sweep(const Request& request, const Service& service, Stopwatch& watch);
/// Of a CSV file with the fields in the query, or JSON with all in the body.
Response identify(const Request& request, const Service& service, Stopwatch& watch);

}  // namespace vines::http
