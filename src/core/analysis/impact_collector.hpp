// Listed impacts of a run: kept in memory, or, if there are too many, recomputed by repeating the
// run whenever they are needed.
#pragma once

#include <functional>
#include <vector>

#include "core/motion/record.hpp"

namespace vines {

/// A range of impacts by their numbers, counted from 0.
struct ImpactRange {
    long first = 0, count = 0;
};

/// Observer of the last `most_listed` impacts of a run. If there are more than `most_kept` of them,
/// the list is dropped and only the quantities derived from all impacts are kept.
class ImpactCollector : public Observer {
public:
    ImpactCollector(std::size_t most_listed, std::size_t most_kept);

    void on_impact(const Impact& impact) override;
    void finish();  ///< call once, after the run

    ImpactRange listed() const;  ///< numbers of the listed impacts
    bool kept() const { return kept_; }

    std::vector<Impact> entries;  ///< all listed impacts, or empty if not kept()
    double typical_speed = 1;     ///< median of the relative speeds; 1 without impacts
    struct NearlyTangent {
        long number;
        double tau, speed;  ///< |x' - y'| before the impact
    };
    std::vector<NearlyTangent> nearly_tangent;

private:
    void conclude(long number, const Impact& impact);

    const std::size_t most_listed_, most_kept_;
    bool kept_ = true;
    long seen_ = 0;
    LastOf<double> speeds_;
};

/// Passes the impacts in `range` to `take`, in order, by repeating the run with its limits. Returns
/// false if limits.stop ended the repetition before the last of them.
bool repeat_impacts(
    const Parameters& parameters, const State& start, const Limits& limits,
    const ImpactRange& range, const std::function<void(const Impact&)>& take);

}  // namespace vines
