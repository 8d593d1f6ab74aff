// All routes of the service.
#pragma once

#include <set>

#include "api/format/sweep_table.hpp"
#include "api/simulate.hpp"
#include "http/metrics.hpp"
#include "http/page.hpp"

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
    std::size_t most_followers = 64;  ///< at once, see RunningStreams
    PageOptions page = {};
};

class LineComputation;  // of a stream (streams.cpp)

/// The running computations whose lines several clients can get, by their requests.
struct RunningStreams {
    std::mutex mutex;
    std::map<std::string, std::weak_ptr<LineComputation>> streams;
    /// Clients of requests that get the lines of another one's computation; each takes a thread.
    std::multiset<std::string> followers;
};

struct Service {
    const RouteOptions options;
    AdmissionControl& admission;
    Metrics& metrics;
    const std::shared_ptr<RunningStreams> running;
};

/// Answers of the routes that compute. Each function waits for admission, reads the request,
/// computes, and encodes the answer. A Problem that it throws is its answer. It records the
/// durations of these phases in the stopwatch.
using Computation = Response(Request& request, const Service& service, Stopwatch& watch);
/// /v1/simulate, /v1/manifold and /v1/identify, which also takes a CSV file with the fields in the
/// query.
Computation answer;
Computation sweep;         ///< /v1/sweep, /v1/basins
Computation continuation;  ///< /v1/continue
Computation design;        ///< /v1/design

/// Sends lines while they are computed, as background work, or, if is_shared, those of a running
/// computation of an equal request. It counts as a sweep and ends after the sweep deadline: lines
/// with an error, a table with a reset connection. Problem 503 if the maximum number of sweeps is
/// running. The service must outlive the response, which can be copied: the sweep's slot is
/// released with the last copy, whether it was sent or not.
Response stream_lines(
    std::shared_ptr<api::LineStream> stream, const Request& asked, const Service& service,
    bool is_shared = false);
/// A sweep as NDJSON lines, or as a table; problem 413 for a table beyond the answer limit. A small
/// sweep of lines is computed once for all equal requests that come while it runs.
Response stream_sweep(
    api::SweepRequest request, api::Format format, const Request& asked, const Service& service);
/// An answer whose lists of impacts are computed while they are sent, as background work. The
/// memory that it holds is not reserved yet.
Response stream_answer(api::Answer answer, const Request& asked, const Service& service);

/// All routes; `admission` and `metrics` must outlive them. Throws std::runtime_error if the folder
/// of the web page cannot be read.
std::vector<Route> make_routes(
    const RouteOptions& options, AdmissionControl& admission, Metrics& metrics);

}  // namespace vines::http
