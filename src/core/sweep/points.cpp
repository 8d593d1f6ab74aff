// Independent points of a sweep, computed on all cores; and the parallel loop.
#include "core/sweep/point.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>

#include "core/sweep/parallel.hpp"

namespace vines {

void parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failure;
    std::mutex failing;
    const auto work = [&] {
        try {
            for (std::size_t i; (i = next++) < count;) task(i);
        } catch (...) {
            next = count;
            const std::lock_guard lock(failing);
            if (!failure) failure = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
    try {
        for (std::size_t t = 1; t < wanted; ++t) others.emplace_back(work);
        // no more threads available: continue with those already started
    } catch (const std::system_error&) {}
    work();
    for (std::thread& t : others) t.join();
    if (failure) std::rethrow_exception(failure);
}

void poll(RunControl& control) {
    const ComputePermit permit(control);
    if (control.stop_or_yield()) throw Stopped();
}

namespace {

PointOptions options_of(const PointSystem& system, PointOptions options) {
    options.max_impacts = system.max_impacts;
    options.known = system.known.get();
    options.units = system.units;
    return options;
}

/// Counts a completed run; throws Stopped if it was interrupted.
void count(const PointResult& result, RunControl& control) {
    if (result.outcome.reason == End::stopped || control.stop_or_yield()) throw Stopped();
    ++control.runs;
    control.impacts += static_cast<std::size_t>(result.impacts);
}

}  // namespace

PointResult run_point(
    const PointSystem& system, const State& start, PointOptions options, RunControl& control) {
    const ComputePermit permit(control);
    if (control.stop_or_yield()) throw Stopped();
    PointResult result = measure(system.parameters, start, options_of(system, options), [&control] {
        return control.stop_or_yield();
    });
    count(result, control);
    return result;
}

void run_points(
    std::size_t count, int threads, const PointOptions& options, RunControl& control,
    const std::function<std::optional<PointTask>(std::size_t)>& task_at) {
    parallel(count, threads, [&](std::size_t i) {
        const std::optional<PointTask> task = task_at(i);
        if (!task) return poll(control);
        std::vector<Motion> motions;
        for (const auto& [name, state] : task->starts)
            motions.push_back({name, state, run_point(task->system, state, options, control)});
        task->done(std::move(motions));
    });
}

}  // namespace vines
