// The impacts of a run that are to be listed: kept, or where they are too many for that, run once
// more whenever they are needed.
#pragma once

#include <functional>
#include <vector>

#include "core/motion/record.hpp"

namespace vines {

/// Some of a run's impacts by their numbers, from 0 on.
struct ImpactRange {
    long first = 0, count = 0;
};

/// The last `most_listed` impacts of a run. Once they are more than `most_kept`, none is kept: only
/// what is concluded from all of them.
class ImpactList : public Observer {
public:
    ImpactList(std::size_t most_listed, std::size_t most_kept);

    void on_impact(const Impact& impact) override;
    /// Once, after the run.
    void finish();

    /// By their numbers those that are listed.
    ImpactRange listed() const;
    bool kept() const { return kept_; }

    std::vector<Impact> entries;  ///< all that are listed, or none
    double typical_speed = 1;     ///< median of their relative speeds, if there are any
    /// An impact next to a tangent contact.
    struct NearlyTangent {
        long number;
        double tau, speed;  ///< |x' - y'| before it
    };
    std::vector<NearlyTangent> nearly_tangent;

private:
    void conclude(long number, const Impact& impact);

    const std::size_t most_listed_, most_kept_;
    bool kept_ = true;
    long seen_ = 0;
    LastOf<double> speeds_;
};

/// Tells some impacts of a run that has been made, in their order, by making it once more; false
/// where `stop` ended that before the last of them. `limits` are those of the run, but that stop
/// may be another.
bool repeat_impacts(
    const Parameters& parameters, const State& start, const Limits& limits,
    const ImpactRange& range, const std::function<void(const Impact&)>& take);

}  // namespace vines
