// How far an identification has come, and whether it is to end.
#pragma once

#include <cstddef>
#include <functional>
#include <utility>

namespace vines {

/// In their order: spikes are looked for, then impacts are refined round by round, then exponents
/// and what they are compared with are computed.
enum class IdentificationStage { spikes, impacts, exponents };

/// Of whoever waits for it.
struct IdentificationWatch {
    std::function<bool()> stop = {};  ///< asked often; true ends it
    /// Told as a stage begins, or a round of it (from 1 on; 0: there are none).
    std::function<void(IdentificationStage, int round)> reached = {};
};

/// Thrown where the watch says stop.
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
    /// For the inner loops: looks now and then. work: how much there is until the next call, in
    /// units of some hundred operations.
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
