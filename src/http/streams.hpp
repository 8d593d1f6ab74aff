// The lines of sweeps, continuations and designs, which are sent while they are computed. They take
// compute slots as background work, and stop when their client leaves.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "api/continuation.hpp"
#include "api/design.hpp"
#include "api/format/sweep_table.hpp"
#include "http/routes.hpp"

namespace vines::http {

class LineComputation;  // of a stream

/// The running computations whose lines several clients can get. Thread-safe; outlives them.
class RunningStreams {
public:
    /// `most_followers`: requests at once that get the lines of another one's computation, since
    /// each takes a thread.
    explicit RunningStreams(int most_followers) : most_followers_(most_followers) {}

    /// The computation of an equal request, null with too many of them; or else the result of
    /// `begin`, which can be null.
    std::shared_ptr<LineComputation> find_or_begin(
        const std::string& request, const std::function<std::shared_ptr<LineComputation>()>& begin);

private:
    const int most_followers_;
    std::atomic<int> followers_ = 0;
    std::mutex mutex_;
    std::map<std::string, std::weak_ptr<LineComputation>> running_;
};

/// A sweep as a stream of NDJSON lines, or as a table. It ends after the sweep deadline: lines with
/// the points so far, a table with a reset connection. Problem 413 for a table beyond the answer
/// limit; 503 if the maximum number of sweeps is running. A small sweep of lines is computed once
/// for all equal requests that come while it runs. The service must outlive the response.
Response stream_sweep(
    api::SweepRequest request, api::Format format, const Request& asked, const Service& service);

/// The branches of a continuation, or the absorbers of a design, as a stream of NDJSON lines, which
/// counts as a sweep: the same slots, deadline and refusals.
Response stream_continuation(
    api::ContinueRequest request, const Request& asked, const Service& service);
Response stream_design(api::DesignRequest request, const Request& asked, const Service& service);

}  // namespace vines::http
