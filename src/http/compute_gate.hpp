// Bounds the computations that run at once: there are many I/O threads, but only so many cores.
//
// Urgent work (one simulation) queues up to a limit and is turned away beyond it. Patient work (the
// points of a sweep) waits as long as it takes, gives way to urgent work whenever some waits, and
// so never makes it wait for more than a moment.
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <set>
#include <stop_token>
#include <thread>

namespace vines::http {

struct ComputeLimits {
    int running = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    int waiting = 64;  ///< urgent ones, beside those that run
    int sweeps = 4;    ///< which share what is left
};

/// Outlives its places and rooms.
class ComputeGate {
    struct Leave {
        void operator()(ComputeGate* gate) const { gate->leave(); }
    };
    struct LeaveSweep {
        void operator()(ComputeGate* gate) const { gate->leave_sweep(); }
    };

public:
    explicit ComputeGate(const ComputeLimits& limits) : limits_(limits), free_(limits.running) {}

    int threads() const { return limits_.running; }

    /// A place to compute in, or none (null). It is given back when it goes.
    using Place = std::unique_ptr<ComputeGate, Leave>;
    /// For urgent work: waits for a place; none where the queue is full.
    Place enter();
    /// For patient work: waits for a place behind all urgent work, and behind the patient work that
    /// came before; none once it is stopped or the gate is closed to sweeps.
    Place enter_patiently(const std::stop_token& stop);
    /// Whether patient work should give its place back and enter again.
    bool wanted() const { return urgent_ > 0; }
    /// Whether other patient work waits for one.
    bool wanted_patiently() const { return patient_ > 0; }

    /// Room for one sweep, or none (null) where there are as many as may be, or the gate is closed
    /// to them.
    using Room = std::unique_ptr<ComputeGate, LeaveSweep>;
    Room enter_sweep();

    /// From now on sweeps end at their next look, and no new one begins: the server is about to
    /// stop. Urgent work goes on.
    void close_to_sweeps();
    bool closed_to_sweeps() const { return closed_to_sweeps_; }

private:
    void leave();
    void leave_sweep();

    const ComputeLimits limits_;
    std::mutex mutex_;
    // One of: a place is free, the last urgent one that waited has got its place, the gate
    // is closed to sweeps.
    std::condition_variable_any changed_;
    int free_, sweeps_ = 0;
    long next_ticket_ = 0;
    std::set<long> tickets_;  ///< of the patient work that waits
    // Changed under the mutex; read without it by work that only takes a look.
    std::atomic<int> urgent_ = 0;   ///< waiting
    std::atomic<int> patient_ = 0;  ///< waiting
    std::atomic<bool> closed_to_sweeps_ = false;
};

}  // namespace vines::http
