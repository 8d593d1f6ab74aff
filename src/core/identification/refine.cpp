#include "core/identification/refine.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "core/identification/displacement.hpp"
#include "core/identification/kinks.hpp"
#include "core/identification/pulse.hpp"

namespace vines {

namespace {

// At most so many rounds; none before the third ends the search.
constexpr int most_rounds = 12, least_rounds = 3;
// What comes back after it was dropped twice would do so for ever.
constexpr int most_rejections = 2;
// The jump of a real impact is the area of its spike; noise and few samples leave that much of it.
constexpr double least_jump = 0.25;
// A jump whose standard error is a third of its spike's area or more may be hidden by the error.
constexpr double hiding_sigmas = 3;
// The mass flies no faster than so many times its typical speed.
constexpr double fastest_flight = 20;
// An impact lies inside of the record, by this share of a sample's step.
constexpr double edge_share = 0.01;
// Until a pulse is fitted it is taken to last so many steps.
constexpr double first_pulse_steps = 2;
// How far around an impact its pulse is looked for: so many pulses, or so many steps.
constexpr double reach_pulses = 1.5, reach_steps = 2.5;
// What lasts longer than so many pulses, and so many steps, is not an impact.
constexpr double longest_spike_pulses = 2, longest_spike_steps = 4;

struct Rejected {
    Spike spike;
    int times;
};

/// What the rounds of the refinement work on.
struct Refinement {
    const Parameters& parameters;
    MeasuredRecord record;      // without its odd samples
    std::vector<Spike> spikes;  // of the impacts as they are known now
    double sigmas;
    double step;  // between samples
    IdentificationProgress& progress;
    RefinedImpacts refined = {{}, {}, 0, {}, {}, true};
    std::vector<Rejected> rejected = {};
    std::optional<RecordStatistics> statistics = {};  // of the record; none once that has changed
};

/// Two spikes that are closer than that may be the same.
double same_within(const Refinement& f) { return 0.5 * (f.refined.pulse + f.step); }

bool is_same(const Refinement& f, const Spike& a, const Spike& b) {
    return std::abs(a.tau - b.tau) < same_within(f) && a.side == b.side;
}

bool any_is_same(const Refinement& f, std::span<const Spike> spikes, const Spike& s) {
    return std::any_of(
        spikes.begin(), spikes.end(), [&](const Spike& k) { return is_same(f, s, k); });
}

/// The same of spikes in order of time, of which only those nearby are looked at.
bool holds(const Refinement& f, std::span<const Spike> spikes, const Spike& s) {
    const double near = 2 * same_within(f);
    const auto earlier = [](const Spike& k, double tau) { return k.tau < tau; };
    const auto first = std::lower_bound(spikes.begin(), spikes.end(), s.tau - near, earlier);
    return any_is_same(f, {first, std::lower_bound(first, spikes.end(), s.tau + near, earlier)}, s);
}

/// The motion between the impacts as they are known now.
void fit(Refinement& f, double pulse) {
    RefinedImpacts& refined = f.refined;
    refined.tau.clear(), refined.side.clear();
    std::sort(f.spikes.begin(), f.spikes.end(), [](const Spike& a, const Spike& b) {
        return a.tau < b.tau;
    });
    const double first = f.record.tau.front() + edge_share * f.step,
                 last = f.record.tau.back() - edge_share * f.step;
    for (Spike& s : f.spikes) {
        s.tau = std::clamp(s.tau, first, last);
        refined.tau.push_back(s.tau);
        refined.side.push_back(s.side);
    }
    refined.pulse = pulse;
    if (!f.statistics) f.statistics.emplace(f.record);
    refined.motion = {};  // its residual is as long as the record
    refined.motion = fit_motion(f.parameters, f.record, *f.statistics, refined.tau, pulse);
    for (std::size_t i = 0; i < f.spikes.size(); ++i) {
        Spike& s = f.spikes[i];
        if (s.side != 0) continue;  // one of which only the moment was given
        s.jump = refined.motion.x_dot[i + 1] - refined.motion.x_dot_before[i];
        s.side = refined.side[i] = s.jump > 0 ? -1 : 1;
    }
}

/// Moves the impacts to where their pulses fit best, and fits the motion between them.
void place_impacts(Refinement& f) {
    const FittedMotion& motion = f.refined.motion;
    const double reach = std::max(reach_pulses * f.refined.pulse, reach_steps * f.step);
    std::vector<ImpactPulse> impacts;
    for (std::size_t i = 0; i < f.spikes.size(); ++i) {
        f.progress.look();
        impacts.emplace_back(f.parameters, f.record, motion, i, reach);
    }
    const double pulse = best_pulse(impacts, f.step, f.refined.pulse, f.progress);
    for (std::size_t i = 0; i < f.spikes.size(); ++i) {
        f.progress.look();
        f.spikes[i].tau = impacts[i].moment(pulse, f.step);
    }
    fit(f, pulse);
}

/// The spikes in what the motion leaves of the acceleration.
std::vector<Spike> spikes_beside_motion(const Refinement& f) {
    const FittedMotion& motion = f.refined.motion;
    const double noise = std::max(motion.noise_x_ddot, f.statistics->x_ddot.least_noise),
                 longest =
                     std::max(longest_spike_pulses * f.refined.pulse, longest_spike_steps * f.step);
    return spikes_in(f.record, motion.x_ddot_residual, noise, f.sigmas, longest);
}

/// Of two spikes of opposite sides in a time in which the mass could not fly from wall to wall,
/// even twenty times as fast as it typically is, one is no impact: that against which the velocity
/// jumps over both. Not of impacts whose moments are given.
std::vector<char> impossible(const Refinement& f) {
    const std::vector<Spike>& spikes = f.spikes;
    std::vector<char> bad(spikes.size(), 0);
    if (!(f.sigmas > 0)) return bad;
    const Parameters& p = f.parameters;
    const FittedMotion& m = f.refined.motion;
    const double least = 2 * p.b * p.epsilon / (fastest_flight * typical_jump(spikes));
    for (std::size_t i = 0; i + 1 < spikes.size(); ++i)
        if (spikes[i].side == -spikes[i + 1].side && spikes[i + 1].tau - spikes[i].tau < least) {
            const int side = m.x_dot[i + 2] > m.x_dot_before[i] ? -1 : 1;
            bad[spikes[i].side == side ? i + 1 : i] = 1;
        }
    return bad;
}

/// What is no impact has no jump, or one of the other sign: the foot of a long pulse, a bump of the
/// cable, an odd sample. `seen`: the spikes beside the motion.
bool is_impact(const Refinement& f, std::size_t i, const std::vector<Spike>& seen) {
    const FittedMotion& m = f.refined.motion;
    const Spike& spike = f.spikes[i];
    const double jump = -spike.side * (m.x_dot[i + 1] - m.x_dot_before[i]),
                 error = m.x_dot_jump_error[i];
    const bool as_its_spike = jump > least_jump * std::abs(spike.jump);
    const bool visible = f.sigmas > 0 ? holds(f, seen, spike) : as_its_spike;
    const bool certain = jump > kink_sigmas * error,
               uncertain = hiding_sigmas * error > std::abs(spike.jump);
    return (visible && (as_its_spike || (uncertain && jump > 0))) || certain;
}

/// Rejected for good it is no impact, so an odd sample: the motion stands for it.
void reject(Refinement& f, const Spike& spike) {
    const auto before = std::find_if(f.rejected.begin(), f.rejected.end(), [&](const Rejected& d) {
        return is_same(f, d.spike, spike);
    });
    if (before == f.rejected.end()) {
        f.rejected.push_back({spike, 1});
    } else if (++before->times == most_rejections) {
        f.statistics.reset();
        for (std::size_t k = 0; k < f.record.tau.size(); ++k)
            if (std::abs(f.record.tau[k] - spike.tau) < f.step)
                f.record.x_ddot[k] -= f.refined.motion.x_ddot_residual[k];
    }
}

std::vector<Spike> kept_of(Refinement& f, const std::vector<Spike>& seen) {
    const std::vector<char> bad = impossible(f);
    std::vector<Spike> kept;
    for (std::size_t i = 0; i < f.spikes.size(); ++i) {
        if (!bad[i] && is_impact(f, i, seen)) kept.push_back(f.spikes[i]);
        else reject(f, f.spikes[i]);
    }
    return kept;
}

/// Adds the spikes and kinks that are new to those kept, which are in order of time, and says
/// whether there are any.
bool add_found(const Refinement& f, std::vector<Spike> found, std::vector<Spike>& kept) {
    if (!f.record.x.empty()) {
        const std::vector<Spike> kinks = find_kinks(
            f.parameters, f.record, f.refined.motion, f.refined.motion.noise_x, f.progress);
        found.insert(found.end(), kinks.begin(), kinks.end());
    }
    std::vector<Spike> added;
    for (const Spike& s : found) {
        const bool hopeless =
            std::any_of(f.rejected.begin(), f.rejected.end(), [&](const Rejected& d) {
                return d.times >= most_rejections && is_same(f, d.spike, s);
            });
        if (!hopeless && !holds(f, kept, s) && !any_is_same(f, added, s)) added.push_back(s);
    }
    kept.insert(kept.end(), added.begin(), added.end());
    return !added.empty();
}

/// What was rejected and did not come back.
std::vector<Spike> dropped_of(const Refinement& f) {
    std::vector<Spike> dropped;
    for (const Rejected& d : f.rejected)
        if (std::none_of(f.spikes.begin(), f.spikes.end(), [&](const Spike& s) {
                return std::abs(s.tau - d.spike.tau) < f.step && s.side == d.spike.side;
            }))
            dropped.push_back(d.spike);
    return dropped;
}

}  // namespace

RefinedImpacts refine_impacts(
    const Parameters& p, const MeasuredRecord& record, std::vector<Spike> spikes, double sigmas,
    IdentificationProgress& progress) {
    progress.reach(IdentificationStage::impacts);
    Refinement f{p, record, std::move(spikes), sigmas, sample_interval(record), progress};
    if (!record.x.empty()) mend_displacement(f.record, typical_jump(f.spikes));
    if (record.x_ddot.empty()) {
        fit(f, 0);
        return std::move(f.refined);
    }
    fit(f, first_pulse_steps * f.step);
    for (int round = 1; round <= most_rounds && !f.spikes.empty(); ++round) {
        progress.reach(IdentificationStage::impacts, round);
        place_impacts(f);
        const std::vector<Spike> seen = spikes_beside_motion(f);
        std::vector<Spike> kept = kept_of(f, seen);
        const bool none_dropped = kept.size() == f.spikes.size(),
                   any_added = sigmas > 0 && round < most_rounds && add_found(f, seen, kept);
        f.spikes = std::move(kept);
        f.refined.settled = none_dropped && !any_added;
        if (f.refined.settled && round >= least_rounds) break;
        // What is returned belongs together, settled or not.
        if (!f.refined.settled) fit(f, f.refined.pulse);
    }
    f.refined.dropped = dropped_of(f);
    return std::move(f.refined);
}

}  // namespace vines
