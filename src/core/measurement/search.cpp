#include "core/measurement/search.hpp"

#include <algorithm>
#include <cmath>

#include "core/measurement/first_candidates.hpp"
#include "core/measurement/frequency_scan.hpp"
#include "core/measurement/no_impacts.hpp"
#include "core/measurement/overlooked.hpp"

namespace vines {

namespace {

// At most so many rounds; with pulses, which the first one reads, there is a second.
constexpr int most_rounds = 10, rounds_with_pulses = 2;
// What comes back after it was dropped twice would do so for ever; it does so within two steps.
constexpr int most_rejections = 2;
constexpr double same_steps = 2;
// How well an event tells the moment of its impact, in steps between samples.
constexpr double event_steps = 0.1;
// A pulse spoils no more than this share of a typical flight, before and after an impact: something
// of the acceleration must be left to fit.
constexpr double most_spoiled = 0.35;
// The record contradicts what is given from so many standard errors on,
// where it matters: k is off by more than that share, c by more than that one.
constexpr double contradiction = 5, least_of_stiffness = 3e-4, least_of_damping = 0.01;
// A jump of x' has a sign from so many standard errors on.
constexpr double side_sigmas = 3;
// Fewer impacts say nothing of the mass.
constexpr std::ptrdiff_t fewest_with_mass = 8;
// Where R and b are far from what they are given as, one run of steps may be too short.
constexpr int most_runs_with_mass = 3;
// An impact could hide in a gap of so much tau.
constexpr double hiding = 0.5;

std::vector<TimeGap> hiding_gaps(const MeasuredRecord& r) {
    std::vector<TimeGap> gaps = time_gaps(r);
    std::erase_if(gaps, [](const TimeGap& g) { return g.to - g.from < hiding; });
    return gaps;
}

class Search {
public:
    Search(
        const Parameters& p, const MeasuredRecord& r, const SearchOptions& o,
        IdentificationProgress& progress)
        : p_(p),
          r_(r),
          o_(o),
          progress_(progress),
          bad_(bad_samples(r)),
          statistics_(r, bad_),
          in_{p, r, bad_, statistics_, o.sigmas},
          fixed_(o.fixed),
          values_(given_unknowns(p)) {
        fixed_[Unknown::stiffness] = fixed_[Unknown::damping] = true;
    }

    FoundImpacts take() {
        progress_.reach(IdentificationStage::spikes);
        begin();
        progress_.reach(IdentificationStage::impacts);
        if (impacts() >= 2) {
            if (!fixed_[Unknown::Omega]) scan_frequency();
            // What the acceleration says of the sensors can be believed once the impacts are known.
            if (!r_.x.empty() && !r_.x_ddot.empty()) settle_displacement();
            limit_extent();
            const auto refit = [this] { fit_all(); };
            settle(refit, rounds_with_pulses);
            if (free_oscillator(r_, pulse_moments())) settle(refit, rounds_with_pulses);
            find_sides();
            if (impacts() >= fewest_with_mass) fit_with_mass();
            finish();
        }
        return std::move(found_);
    }

private:
    void begin() {
        found_.gaps = hiding_gaps(r_);
        if (o_.moments.empty()) {
            FirstCandidates first = first_candidates(in_, progress_);
            candidates_ = std::move(first.candidates);
            spoiled_.a = first.extent;
            values_[Unknown::x_delay] = first.x_delay;
        } else {
            spoiled_.a = unknown_extent(statistics_);
            for (const double tau : o_.moments) candidates_.push_back({.tau = tau});
        }
        std::erase_if(candidates_, [this](const Candidate& c) { return is_in_gap(c.tau); });
        for (const TimeGap& g : found_.gaps)
            candidates_.push_back({.tau = 0.5 * (g.from + g.to), .is_gap = true});
        sort_by_time(candidates_);
    }

    bool is_in_gap(double tau) const {
        return std::any_of(found_.gaps.begin(), found_.gaps.end(), [tau](const TimeGap& g) {
            return g.from < tau && tau < g.to;
        });
    }

    std::ptrdiff_t impacts() const {
        return std::count_if(
            candidates_.begin(), candidates_.end(), [](const Candidate& c) { return !c.is_gap; });
    }

    /// Impacts without an event in the acceleration.
    std::ptrdiff_t unseen() const {
        return std::count_if(candidates_.begin(), candidates_.end(), [](const Candidate& c) {
            return c.height == 0 && !c.is_gap;
        });
    }

    void scan_frequency() {
        std::vector<double> moments;
        for (const Candidate& c : candidates_) moments.push_back(c.tau);
        values_[Unknown::Omega] = scanned_frequency(input(r_), moments, progress_);
    }

    JointFitInput input(const MeasuredRecord& record) const {
        return {p_, record, statistics_, bad_.x, bad_.a, spoiled_.x, fixed_};
    }

    /// Fits the displacement alone, with the moments of the events: so much does not depend on what
    /// else is wrong with the acceleration.
    void settle_displacement() {
        const MeasuredRecord by_x{r_.tau, r_.x, {}};
        const auto refit = [&] {
            fit(by_x, event_moments());
            spoiled_.x = kink_extent(found_.fit, r_, bad_.x, statistics_.step);
        };
        refit();
        free_oscillator(by_x, event_moments());
        // Where nearly each has its pulse, nothing is to be found.
        settle(refit, 20 * unseen() > impacts() ? 2 : 1);
    }

    std::vector<ImpactMoment> event_moments() const {
        const double error = event_steps * statistics_.step;
        std::vector<ImpactMoment> all;
        for (const Candidate& c : candidates_)
            all.push_back({c.tau, c.is_gap, c.event, c.height != 0 ? error : infinity, 0, 0});
        return all;
    }

    std::vector<ImpactMoment> pulse_moments() const {
        std::vector<ImpactMoment> all;
        for (const Candidate& c : candidates_)
            all.push_back(
                {c.tau, c.is_gap, c.pulse_tau, c.pulse_error, c.is_gap ? 0 : spoiled_.a.before,
                 c.is_gap ? 0 : spoiled_.a.after});
        return all;
    }

    /// Rounds of a fit, until none adds or drops an impact.
    template <class Refit>
    void settle(const Refit& refit, int least_rounds) {
        for (int round = 1; round <= most_rounds && impacts() > 1; ++round) {
            progress_.reach(IdentificationStage::impacts, ++rounds_);
            refit();
            const bool dropped = drop(), added = o_.moments.empty() && round < most_rounds && add();
            found_.settled = !dropped && !added;
            changed_ = !found_.settled;
            if (found_.settled && round >= least_rounds) return;
        }
        if (!found_.settled) refit();
    }

    /// From where the last fit ended, if it was of the same impacts. Its moments and values are the
    /// next one's start.
    void fit(const MeasuredRecord& record, const std::vector<ImpactMoment>& moments) {
        JointFit& last = found_.fit;
        last.x_left = {}, last.a_left = {};  // as long as the record
        last = fit_jointly(input(record), moments, values_, changed_ ? nullptr : &last, progress_);
        changed_ = false;
        values_ = last.values;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            candidates_[i].tau = last.impacts[i].tau;
            candidates_[i].jump = last.impacts[i].jump();
        }
    }

    /// The motion, then how far the pulses reach, what they look like, and where that puts each
    /// impact.
    void fit_all() {
        fit(r_, pulse_moments());
        if (!r_.x.empty()) spoiled_.x = kink_extent(found_.fit, r_, bad_.x, statistics_.step);
        if (r_.x_ddot.empty()) return;
        spoiled_.a = pulse_extent(found_.fit, r_, statistics_.step);
        limit_extent();
        found_.pulse = PulseTemplate(found_.fit, r_, bad_.a, statistics_.step, spoiled_.a);
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            Candidate& c = candidates_[i];
            if (c.is_gap) continue;
            const PulseMoment m =
                pulse_moment(found_.pulse, found_.fit, i, r_, bad_.a, statistics_.step);
            c.pulse_tau = m.tau, c.pulse_error = m.error;
        }
        values_[Unknown::pulse_lag] = 0;
    }

    void find_sides() {
        for (std::size_t i = 0; i < candidates_.size(); ++i)
            sides_.push_back(candidates_[i].is_gap ? 0 : side_of(i));
    }

    /// Once the impacts are known the mass tells more of their moments, and its R and b.
    void fit_with_mass() {
        JointFitInput with_mass = input(r_);
        with_mass.sides = &sides_;
        JointFit fit = found_.fit;
        for (int run = 0; run < most_runs_with_mass && !(run > 0 && fit.converged); ++run)
            fit = fit_jointly(with_mass, pulse_moments(), fit.values, &fit, progress_);
        found_.with_mass = fit.converged;
        if (fit.converged) found_.fit = std::move(fit);
    }

    void limit_extent() {
        std::vector<double> flights;
        for (std::size_t i = 1; i < candidates_.size(); ++i)
            flights.push_back(candidates_[i].tau - candidates_[i - 1].tau);
        const double most = most_spoiled * median(std::move(flights));
        spoiled_.a = {std::min(spoiled_.a.before, most), std::min(spoiled_.a.after, most)};
    }

    /// The oscillator is as it is given unless the record contradicts: says whether it does.
    bool free_oscillator(const MeasuredRecord& record, const std::vector<ImpactMoment>& moments) {
        const bool is_free = !fixed_[Unknown::stiffness] || !fixed_[Unknown::damping];
        if (is_free || (o_.fixed[Unknown::stiffness] && o_.fixed[Unknown::damping])) return false;
        JointFitInput free = input(record);
        free.fixed = o_.fixed;
        free.one_step = true;
        const JointFit trial = fit_jointly(free, moments, values_, &found_.fit, progress_);
        const UnknownValues given = given_unknowns(p_);
        const auto contradicts = [&](Unknown u, double least) {
            return std::abs(trial.values[u] - given[u]) >
                   std::max(contradiction * trial.errors[u], least * given[u]);
        };
        if (!contradicts(Unknown::stiffness, least_of_stiffness) &&
            !contradicts(Unknown::damping, least_of_damping))
            return false;
        fixed_ = o_.fixed;
        values_ = trial.values;
        return true;
    }

    /// Drops what is no impact; says whether there was any.
    bool drop() {
        const bool searched = o_.moments.empty();
        const std::vector<char> none = no_impacts(p_, candidates_, found_.fit, searched);
        std::vector<Candidate> kept;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            const Candidate& c = candidates_[i];
            if (none[i]) rejected_.push_back({c.tau, c.height != 0 || !searched});
            else kept.push_back(c);
        }
        const bool any = kept.size() < candidates_.size();
        candidates_ = std::move(kept);
        return any;
    }

    bool add() {
        bool any = false;
        for (const Candidate& c : overlooked(in_, found_.fit, spoiled_, progress_)) {
            const auto times =
                std::count_if(rejected_.begin(), rejected_.end(), [&](const Rejected& d) {
                    return std::abs(d.tau - c.tau) < same_steps * statistics_.step;
                });
            if (times >= most_rejections || is_in_gap(c.tau)) continue;
            candidates_.push_back(c);
            any = true;
        }
        sort_by_time(candidates_);
        return any;
    }

    /// The wall pushes x back; its pulse says so where the jump of x' does not.
    int side_of(std::size_t impact) const {
        const Candidate& c = candidates_[impact];
        const double error = found_.fit.impacts[impact].x_dot_jump_error;
        const bool by_pulse = c.height != 0 && !(std::abs(c.jump) > side_sigmas * error);
        return (by_pulse ? c.height : c.jump) > 0 ? -1 : 1;
    }

    void finish() {
        for (const Rejected& d : rejected_)
            if (d.is_shown &&
                std::none_of(candidates_.begin(), candidates_.end(), [&](const Candidate& c) {
                    return std::abs(c.tau - d.tau) < beside_impact;
                }))
                found_.dropped.push_back(d.tau);
        std::sort(found_.dropped.begin(), found_.dropped.end());
        // Of given moments no pulses are looked for.
        found_.unseen = o_.moments.empty() ? unseen() : 0;
        found_.side = std::move(sides_);
        std::erase(found_.side, 0);
        std::erase_if(found_.fit.impacts, [](const FittedImpact& i) { return i.is_gap; });
        found_.extent = spoiled_.a;
    }

    const Parameters& p_;
    const MeasuredRecord& r_;
    const SearchOptions& o_;
    IdentificationProgress& progress_;
    const BadSamples bad_;
    const RecordStatistics statistics_;
    const SearchedRecord in_;
    FixedUnknowns fixed_;
    UnknownValues values_;
    Sides sides_;
    SpoiledExtents spoiled_;
    std::vector<Candidate> candidates_;
    struct Rejected {
        double tau;
        bool is_shown;  ///< by a pulse, or given
    };
    std::vector<Rejected> rejected_;
    int rounds_ = 0;
    bool changed_ = true;  // the candidates, since the last fit
    FoundImpacts found_;
};

}  // namespace

FoundImpacts find_impacts(
    const Parameters& p, const MeasuredRecord& r, const SearchOptions& o,
    IdentificationProgress& progress) {
    return Search(p, r, o, progress).take();
}

}  // namespace vines
