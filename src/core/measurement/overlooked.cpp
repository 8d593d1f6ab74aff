#include "core/measurement/overlooked.hpp"

#include <algorithm>

#include "core/measurement/missed_impact.hpp"

namespace vines {

namespace {

// More pulses than this share of the impacts are none, but something else that is wrong.
constexpr double most_overlooked = 0.1;

/// Beside the pulses of the impacts that are known.
std::vector<Candidate> pulses(
    const SearchedRecord& in, const JointFit& fit, const PulseExtent& extent,
    IdentificationProgress& progress) {
    const MeasuredRecord& r = in.record;
    PulseSignal signal{fit.a_left, fit.noise_a};
    std::vector<char> passed_over = in.bad.a_without_clipped();
    for (const FittedImpact& i : fit.impacts) {
        const double from = i.tau - std::max(extent.before, beside_impact),
                     to = i.tau + std::max(extent.after, beside_impact);
        for (std::size_t k = first_index(r, from); k < r.tau.size() && r.tau[k] < to; ++k)
            passed_over[k] = 1;
    }
    std::vector<Candidate> found;
    const PulseEvents seen =
        pulse_events(r.tau, in.statistics.step, signal, passed_over, in.sigmas, progress);
    for (const PulseEvent& e : seen.events) found.push_back(candidate_of(e));
    if (static_cast<double>(found.size()) >
        most_overlooked * static_cast<double>(fit.impacts.size()))
        return {};
    return found;
}

void add_kinks(
    const SearchedRecord& in, const JointFit& fit, double x_spoiled,
    IdentificationProgress& progress, std::vector<Candidate>& found) {
    const UnknownValues& v = fit.values;
    const IntervalFlows flows(v, false, fit.epsilon);
    const double noise = std::max(fit.noise_x, in.statistics.x.noise);
    for (std::size_t i = 0; i < fit.intervals.size(); ++i) {
        progress.look();
        const double from = fit.intervals[i].tau + x_spoiled,
                     to = (i + 1 < fit.intervals.size() ? fit.intervals[i + 1].tau
                                                        : in.record.tau.back()) -
                          x_spoiled;
        const auto missed = missed_impact(
            {in.record.tau, fit.x_left, in.bad.x, noise, v[Unknown::x_delay], from, to},
            flows.of(fit.intervals[i]).parts, false);
        if (missed)
            found.push_back({.tau = missed->tau, .jump = missed->jump / v[Unknown::x_gain]});
    }
}

}  // namespace

std::vector<Candidate> overlooked(
    const SearchedRecord& in, const JointFit& fit, const SpoiledExtents& spoiled,
    IdentificationProgress& progress) {
    std::vector<Candidate> found;
    if (!fit.a_left.empty()) found = pulses(in, fit, spoiled.a, progress);
    if (!in.record.x.empty()) add_kinks(in, fit, spoiled.x, progress, found);
    return found;
}

}  // namespace vines
