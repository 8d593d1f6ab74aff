// Progress and cancellation of an identification.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <utility>

namespace vines {

/// Stages: detecting spikes, refining impacts round by round, computing exponents and comparisons.
enum class IdentificationStage { spikes, impacts, exponents };

/// Called often by a function that takes long; an exception it throws passes through.
using Look = std::function<void()>;

/// Callbacks of the caller.
struct IdentificationWatch {
    std::function<bool()> stop = {};  ///< called often; true ends the identification
    /// Called at the start of a stage, or of one of its rounds (from 1; 0: no rounds).
    std::function<void(IdentificationStage, int round)> reached = {};
    /// Impacts of one fit, which takes 2 kB for each.
    std::size_t most_impacts = std::numeric_limits<std::size_t>::max();
};

/// Thrown when a record shows more impacts than the watch permits.
struct TooManyImpacts {};

/// Thrown when the watch requests a stop.
struct IdentificationStopped {
    IdentificationStage stage;
    int round;
};

class IdentificationProgress {
public:
    explicit IdentificationProgress(IdentificationWatch watch = {}) : watch_(std::move(watch)) {}

    void reach(IdentificationStage stage, int round = 0) {
        at_ = {stage, round};
        if (watch_.reached) watch_.reached(stage, round);
        look();
    }
    void look() const {
        if (watch_.stop && watch_.stop()) throw at_;
    }
    void check_impacts(std::size_t impacts) const {
        if (impacts > watch_.most_impacts) throw TooManyImpacts();
    }
    /// For inner loops: calls look() now and then. work: in units of a few hundred operations.
    void tick(std::size_t work = 1) {
        ticks_ += work;
        if (ticks_ < ticks_per_look) return;
        ticks_ = 0;
        look();
    }
    const std::function<bool()>& stop() const { return watch_.stop; }

private:
    static constexpr std::size_t ticks_per_look = 256;
    const IdentificationWatch watch_;
    IdentificationStopped at_ = {IdentificationStage::spikes, 0};
    std::size_t ticks_ = 0;
};

}  // namespace vines
