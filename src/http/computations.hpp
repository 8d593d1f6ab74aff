// The routes that compute: /v1/simulate, /v1/manifold, /v1/sweep, /v1/identify.
// Each function waits for admission, reads the request, computes, and encodes the answer. A Problem
// that it throws is its answer. It records the durations of these phases in the stopwatch.
#pragma once

#include "http/routes.hpp"
#include "http/stopwatch.hpp"

namespace vines::http {

struct Service {
    const RouteOptions options;
    AdmissionControl& admission;
    Metrics& metrics;
};

Response simulate(const Request& request, const Service& service, Stopwatch& watch);
Response manifold(const Request& request, const Service& service, Stopwatch& watch);
Response sweep(const Request& request, const Service& service, Stopwatch& watch);
/// Takes a CSV file with the fields in the query, or JSON with everything in the body.
Response identify(const Request& request, const Service& service, Stopwatch& watch);

}  // namespace vines::http
