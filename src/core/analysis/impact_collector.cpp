#include "core/analysis/impact_collector.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace vines {

namespace {

/// Threshold of kappa = |x''/(x'- - y'-)| above which an impact counts as nearly tangent. The
/// condition number of M is about 14 kappa^2 at R = .6: an ulp becomes a relative error of 1e-8.
constexpr double nearly_tangent_ratio = 1800;

// Length of the longest list that the service makes; longer ones are reallocated.
constexpr std::size_t most_reserved = 2000000;

/// Impacts of a chatter are slow as well, but neighbouring motions have them too.
bool is_nearly_tangent(const Impact& i) {
    return !(i.side * i.x_ddot_before > 0) &&
           std::abs(i.x_ddot_before) > nearly_tangent_ratio * std::abs(i.relative_speed_before);
}

class Repetition : public Observer {
public:
    Repetition(const ImpactRange& range, const std::function<void(const Impact&)>& take)
        : range_(range),
          take_(take) {}
    void on_impact(const Impact& impact) override {
        const long number = seen_++ - range_.first;
        if (number >= 0 && number < range_.count) take_(impact);
    }
    bool complete() const { return seen_ >= range_.first + range_.count; }

private:
    const ImpactRange range_;
    const std::function<void(const Impact&)>& take_;
    long seen_ = 0;
};

}  // namespace

ImpactCollector::ImpactCollector(std::size_t most_listed, std::size_t most_kept)
    : most_listed_(most_listed),
      most_kept_(most_kept),
      speeds_(most_listed) {}

void ImpactCollector::on_impact(const Impact& impact) {
    if (!kept_) return conclude(seen_++, impact);
    ++seen_;
    entries.push_back(impact);
    keep_last(entries, most_listed_);
    if (std::min(entries.size(), most_listed_) <= most_kept_) return;
    kept_ = false;
    // Reserved: reallocation would cost half as much time again. Unwritten memory takes no RAM.
    speeds_.entries.reserve(std::min(most_listed_, most_reserved));
    for (std::size_t k = 0; k < entries.size(); ++k) conclude(static_cast<long>(k), entries[k]);
    entries = {};
}

void ImpactCollector::conclude(long number, const Impact& impact) {
    const double speed = std::abs(impact.relative_speed_before);
    speeds_.add(speed);
    if (is_nearly_tangent(impact)) nearly_tangent.push_back({number, impact.tau, speed});
}

void ImpactCollector::finish() {
    trim_to_last(entries, most_listed_);
    const long first = listed().first;
    for (std::size_t k = 0; k < entries.size(); ++k)
        conclude(first + static_cast<long>(k), entries[k]);
    std::erase_if(nearly_tangent, [first](const NearlyTangent& n) { return n.number < first; });
    trim_to_last(speeds_.entries, most_listed_);
    std::vector<double> speeds = std::move(speeds_.entries);
    if (speeds.empty()) return;
    const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
    std::nth_element(speeds.begin(), middle, speeds.end());
    typical_speed = *middle;
}

ImpactRange ImpactCollector::listed() const {
    const auto seen = static_cast<std::size_t>(seen_), count = std::min(seen, most_listed_);
    return {static_cast<long>(seen - count), static_cast<long>(count)};
}

bool repeat_impacts(
    const Parameters& p, const State& start, const Limits& limits, const ImpactRange& range,
    const std::function<void(const Impact&)>& take) {
    Repetition repetition(range, take);
    Limits until = limits;
    until.stop = [&] { return repetition.complete() || (limits.stop && limits.stop()); };
    simulate(p, start, until, {&repetition});
    return repetition.complete();
}

}  // namespace vines
