// What a sweep asks of the place that it runs in.
#pragma once

#include <atomic>
#include <cstddef>

namespace vines {

class Pace {
public:
    virtual ~Pace() = default;
    /// Before a thread's first run, and, behind an end(), before each of its runs.
    virtual void begin() {}
    virtual void end() {}
    /// Asked every few events; true stops the sweep.
    virtual bool stop_or_yield() { return false; }

    std::atomic<std::size_t> runs = 0;     ///< that are done: of SweepPlan::runs()
    std::atomic<std::size_t> impacts = 0;  ///< of their measured parts
};

/// Thrown where the pace says stop.
struct Stopped {};

/// A place in the computing that is held while it is in scope.
class Turn {
public:
    explicit Turn(Pace& pace) : pace_(pace) { pace_.begin(); }
    ~Turn() { pace_.end(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

    /// To the end of the queue.
    void again() {
        pace_.end();
        pace_.begin();
    }

private:
    Pace& pace_;
};

}  // namespace vines
