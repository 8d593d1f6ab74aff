// Long computations on all cores: a parallel loop, and the interface to the host that grants
// permits, stops the work and reads its progress.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace vines {

/// Interface between a long computation and its host; the default never waits or stops.
class RunControl {
public:
    virtual ~RunControl() = default;
    /// Blocks until a permit is granted, which a thread needs for its runs.
    virtual void begin() {}
    /// Returns the permit of the matching begin().
    virtual void end() {}
    /// Called every few events. Returns true to stop the computation; can block for other work.
    virtual bool stop_or_yield() { return false; }

    std::atomic<std::size_t> runs = 0;     ///< completed runs, out of SweepPlan::runs()
    std::atomic<std::size_t> impacts = 0;  ///< impacts in the measured cycles of these runs
};

struct Stopped {};  ///< thrown by the computation once stop_or_yield() returned true

/// Throws Stopped after a stop request.
inline void poll(RunControl& control) {
    if (control.stop_or_yield()) throw Stopped();
}

/// A permit to compute, held while in scope. A thread with one gets no further one.
class ComputePermit {
public:
    explicit ComputePermit(RunControl& control) : control_(control) {
        if (depth_ == 0) control_.begin();
        ++depth_;
    }
    ~ComputePermit() {
        if (--depth_ == 0) control_.end();
    }
    ComputePermit(const ComputePermit&) = delete;
    ComputePermit& operator=(const ComputePermit&) = delete;

private:
    RunControl& control_;
    static inline thread_local int depth_ = 0;
};

/// Calls task(0), ..., task(count - 1), each once, from `threads` threads (at least one; fewer if
/// the system refuses more), and returns when all are done. If a task throws, no further task
/// starts, and the exception is rethrown once the other threads have returned. control: each thread
/// keeps a permit from its first task to its last.
void parallel(
    std::size_t count, int threads, RunControl* control,
    const std::function<void(std::size_t)>& task);

}  // namespace vines
