// Long computations on all cores: a parallel loop, and the interface to the host that grants
// permits, stops the work and reads its progress.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace vines {

/// Calls task(0), ..., task(count - 1), each once, from `threads` threads (fewer if the system
/// refuses more), and returns when all are done. If a task throws, no further task starts, and the
/// exception is rethrown once the other threads have returned.
void parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

/// Interface between a long computation and its host; the default never waits or stops.
class RunControl {
public:
    virtual ~RunControl() = default;
    /// Waits for a permit. Called before a thread's first run and, after end(), before each run.
    virtual void begin() {}
    virtual void end() {}
    /// Polled every few events. Can wait in favour of other work; true stops the computation.
    virtual bool stop_or_yield() { return false; }

    std::atomic<std::size_t> runs = 0;     ///< completed runs, of SweepPlan::runs()
    std::atomic<std::size_t> impacts = 0;  ///< impacts in their measured parts
};

struct Stopped {};  ///< thrown after a stop request

/// A permit to compute, held while in scope.
class ComputePermit {
public:
    explicit ComputePermit(RunControl& control) : control_(control) { control_.begin(); }
    ~ComputePermit() { control_.end(); }
    ComputePermit(const ComputePermit&) = delete;
    ComputePermit& operator=(const ComputePermit&) = delete;

    /// Returns the permit and queues for a new one.
    void requeue() {
        control_.end();
        control_.begin();
    }

private:
    RunControl& control_;
};

}  // namespace vines
