// Bounds the computations that run at once: there are many I/O threads, but only so many cores.
//
// Urgent work (one simulation) queues up to a limit and is turned away beyond it. Patient work (the
// points of a sweep) waits as long as it takes, gives way to urgent work whenever some waits, and
// so never makes it wait for more than a moment. To wait for a place is a change of threads, which
// takes longer than a small answer: urgent work may begin without one (turn.hpp).
#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <stop_token>
#include <thread>

namespace vines::http {

struct ComputeLimits {
    int running = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    int waiting = 64;  ///< urgent ones, beside those that run
    int sweeps = 4;    ///< which share what is left
};

/// What is in work at a moment.
struct ComputeLoad {
    int running = 0;          ///< places that are taken
    std::size_t waiting = 0;  ///< urgent work that waits for one
    int sweeps = 0;
};

/// Outlives its places and rooms.
class ComputeGate {
    struct Leave {
        void operator()(ComputeGate* gate) const { gate->leave(); }
    };
    struct LeaveSweep {
        void operator()(ComputeGate* gate) const { gate->leave_sweep(); }
    };
    struct EndMoment {
        void operator()(ComputeGate* gate) const { gate->end_moment(); }
    };

public:
    explicit ComputeGate(const ComputeLimits& limits) : limits_(limits), free_(limits.running) {}

    int threads() const { return limits_.running; }

    /// A place to compute in, or none (null). It is given back when it goes.
    using Place = std::unique_ptr<ComputeGate, Leave>;
    /// A moment in which urgent work computes without a place. To the queue's limit it counts as if
    /// it waited.
    using Moment = std::unique_ptr<ComputeGate, EndMoment>;
    /// For urgent work that does not wait: one of both, or neither.
    struct Begin {
        Place place;
        Moment moment;
    };
    Begin begin();
    /// For urgent work: waits for a place, first come, first served; none where the queue is full,
    /// or once it is given up, which is asked now and then. Who has had a moment finds room in it.
    Place enter(const std::function<bool()>& gives_up = {}, Moment moment = {});
    /// For patient work: waits for a place behind all urgent work, and behind the patient work that
    /// came before; none once it is stopped or the gate is closed to sweeps.
    Place enter_patiently(const std::stop_token& stop);
    /// Whether patient work should give its place back and enter again.
    bool wanted() const { return wanted_; }
    /// Whether other patient work waits for one.
    bool wanted_patiently() const { return wanted_patiently_; }

    /// Room for one sweep, or none (null) where there are as many as may be, or the gate is closed
    /// to them.
    using Room = std::unique_ptr<ComputeGate, LeaveSweep>;
    Room enter_sweep();

    /// From now on sweeps end at their next look, and no new one begins: the server is about to
    /// stop. Urgent work goes on.
    void close_to_sweeps();
    bool closed_to_sweeps() const { return closed_to_sweeps_; }

    /// From now on all work ends at its next look, with what it has.
    void end_all() { ends_all_ = true; }
    bool ends_all() const { return ends_all_; }

    ComputeLoad load() const;

private:
    struct Waiting {
        std::condition_variable_any changed = {};
        bool enters = false;  ///< its place is taken already
    };
    using Queue = std::list<Waiting*>;

    void leave();
    void leave_sweep();
    void end_moment();
    bool is_full() const;
    void hand_out();
    bool drop_out(Queue& queue, Waiting& waiting);

    const ComputeLimits limits_;
    mutable std::mutex mutex_;
    int free_, sweeps_ = 0, moments_ = 0;  // where a place is free, nobody waits
    Queue urgent_, patient_;
    // Changed under the mutex; read without it by work that only takes a look.
    std::atomic<bool> wanted_ = false, wanted_patiently_ = false;
    std::atomic<bool> closed_to_sweeps_ = false, ends_all_ = false;
};

}  // namespace vines::http
