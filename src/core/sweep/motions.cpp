#include "core/sweep/motions.hpp"

#include <algorithm>

namespace vines {

namespace {

double peak_of(const Motion& m) { return m.result.x_max; }

const Motion* from_start(const SweepPoint& point, const std::string& name) {
    const auto m = std::find_if(
        point.motions.begin(), point.motions.end(),
        [&](const Motion& motion) { return motion.start == name && motion.result.measured; });
    return m == point.motions.end() ? nullptr : &*m;
}

/// In the order in which they come first.
std::vector<std::string> start_names(std::span<const SweepPoint> row) {
    std::vector<std::string> names;
    for (const SweepPoint& point : row)
        for (const Motion& m : point.motions)
            if (std::find(names.begin(), names.end(), m.start) == names.end())
                names.push_back(m.start);
    return names;
}

}  // namespace

std::vector<const Motion*> ranked(const SweepPoint& point) {
    std::vector<const Motion*> motions;
    for (const Motion& m : point.motions)
        if (m.result.measured) motions.push_back(&m);
    std::stable_sort(motions.begin(), motions.end(), [](const Motion* a, const Motion* b) {
        return peak_of(*a) < peak_of(*b);
    });
    return motions;
}

bool depends_on_start(const std::vector<const Motion*>& motions) {
    return std::any_of(motions.begin(), motions.end(), [&](const Motion* m) {
        return ends_elsewhere(motions.back()->result, m->result);
    });
}

std::optional<bool> depends_on_start(const SweepPoint& point, bool default_set) {
    const auto motions = ranked(point);
    if (default_set) return depends_on_start(motions);
    if (!point.second) return std::nullopt;
    return !motions.empty() && point.second->result.measured &&
           ends_elsewhere(motions.back()->result, point.second->result);
}

RowSummary summary_of(std::span<const SweepPoint> row, bool largest, bool default_set) {
    RowSummary s;
    auto beats = [largest](double one, double other) {
        return largest ? one > other : one < other;
    };
    auto offer = [&](Peak& peak, std::size_t at, const Motion* m) {
        if (m && (!peak.motion || beats(peak_of(*m), peak_of(*peak.motion)))) peak = {at, m};
    };
    s.points = row.size();
    for (std::string& name : start_names(row)) s.starts.push_back({std::move(name), {}});
    for (std::size_t k = 0; k < row.size(); ++k) {
        const SweepPoint& point = row[k];
        const auto motions = ranked(point);
        if (motions.empty()) {
            ++s.missing;
            continue;
        }
        offer(s.worst, k, motions.back());
        offer(s.best, k, motions.front());
        for (auto& of_start : s.starts) offer(of_start.peak, k, from_start(point, of_start.start));
        const auto x_free = motions.back()->result.x_free;
        if (x_free && (!s.x_free || beats(*x_free, *s.x_free))) s.x_free = x_free;
        if (!default_set && !point.second) continue;
        const bool elsewhere = default_set
                                   ? depends_on_start(motions)
                                   : ends_elsewhere(motions.back()->result, point.second->result);
        s.depends_on_start = s.depends_on_start.value_or(false) || elsewhere;
    }
    return s;
}

}  // namespace vines
