// All routes of the service.
#pragma once

#include <string>
#include <vector>

#include "api/simulate.hpp"
#include "http/admission_control.hpp"
#include "http/metrics.hpp"
#include "http/page.hpp"
#include "http/route.hpp"

namespace vines::http {

struct RouteOptions {
    double deadline = 30;               ///< time for a computation without its wait in the queue, s
    double sweep_deadline = 3600;       ///< duration of one sweep's stream, s
    std::size_t sweep_points = 100000;  ///< maximum number of points of one sweep
    std::size_t record_limit = 64 << 20;   ///< largest record sent to /v1/identify, bytes
    std::size_t answer_limit = 128 << 20;  ///< largest JSON answer, bytes
    /// A JSON answer that lists more impacts is streamed; the columns of impacts are then generated
    /// while it is sent.
    std::size_t most_kept_impacts = api::most_kept_impacts;
    PageOptions page = {};
};

/// All routes; `admission` and `metrics` must outlive them. Throws std::runtime_error if the folder
/// of the web page cannot be read.
std::vector<Route> make_routes(
    const RouteOptions& options, AdmissionControl& admission, Metrics& metrics);

}  // namespace vines::http
