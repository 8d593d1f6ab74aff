// Sweeps: many points on all cores, each handed out as a line of NDJSON as soon as it is known.
#pragma once

#include <atomic>
#include <functional>

#include "api/sweep_line.hpp"

namespace vines::api {

/// What a sweep asks of the place that it runs in.
class Pace {
public:
    virtual ~Pace() = default;
    /// Before a point is computed, on the thread that does it.
    virtual void begin() {}
    virtual void end() {}
    /// Asked every few events; true stops the sweep.
    virtual bool stop_or_yield() { return false; }

    std::atomic<std::size_t> runs = 0;  ///< that are done: of runs_of()
};

/// How many runs the wanted lines take, about: where rows are computed together their lines come
/// late, and only the runs tell how far it is.
std::size_t runs_of(const SweepRequest& request);

/// Computes the points wanted on so many threads and hands out each as a line {type: point, index,
/// ...}, in the order in which they come. `point` is called by one thread at a time. A line depends
/// on the request and its index alone. Returns what is worth a warning about all of them; empty if
/// nothing is.
std::string run_sweep(
    const SweepRequest& request, int threads, Pace& pace,
    const std::function<void(std::size_t index, const Json& line)>& point);

}  // namespace vines::api
