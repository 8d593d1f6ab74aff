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
// Masses and springs are known to far better than that, and a damping to a factor.
constexpr double most_of_stiffness = 0.04, most_of_damping = 2.5, slack_of_damping = 0.005;
// A jump of x' has a sign from so many standard errors on.
constexpr double side_sigmas = 3;
// Fewer impacts say nothing of the mass.
constexpr std::ptrdiff_t fewest_with_mass = 8;
// Where R and b are far from what they are given as, one run of steps may be too short.
constexpr int most_runs_with_mass = 3;
// So often what is hidden is looked for, and all fitted anew.
constexpr int most_hidden_rounds = 3;
// After the first time not for fewer changes, of all impacts.
constexpr double few_changes = 0.02;
// An impact is there if its jump of x' is what its pulse promises, to that share: one that stands
// for others jumps by what they do together.
constexpr double kept_promise = 0.3;
// What leads to an impact meets the oscillator there, to that share of the typical jump.
constexpr double hidden_tolerance = 0.05;
// Nothing is hidden for longer than so many typical flights.
constexpr double longest_flights = 40;
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
            if (return_to_given()) settle(refit, rounds_with_pulses);
            find_sides();
            if (impacts() >= fewest_with_mass) fit_with_mass();
            for (int round = 0; round < most_hidden_rounds && put_in_hidden(); ++round) {
                settle(refit, 1);
                find_sides();
                fit_with_mass();
            }
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
            candidates_.push_back({.tau = 0.5 * (g.from + g.to), .border = Border::gap});
        sort_by_time(candidates_);
    }

    bool is_in_gap(double tau) const {
        return std::any_of(found_.gaps.begin(), found_.gaps.end(), [tau](const TimeGap& g) {
            return g.from < tau && tau < g.to;
        });
    }

    std::ptrdiff_t impacts() const {
        return std::count_if(candidates_.begin(), candidates_.end(), [](const Candidate& c) {
            return c.is_impact();
        });
    }

    /// Impacts without an event in the acceleration.
    std::ptrdiff_t unseen() const {
        return std::count_if(candidates_.begin(), candidates_.end(), [](const Candidate& c) {
            return c.height == 0 && c.is_impact() && !c.is_predicted();
        });
    }

    void scan_frequency() {
        std::vector<double> moments;
        for (const Candidate& c : candidates_) moments.push_back(c.tau);
        values_[Unknown::Omega] = scanned_frequency(input(r_), moments, progress_);
    }

    JointFitInput input(const MeasuredRecord& record) const {
        return {p_, record, statistics_, bad_.x, bad_.a, spoiled_.x, fixed_, o_.forcing};
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
        if (return_to_given()) settle(refit, 1);
    }

    std::vector<ImpactMoment> event_moments() const {
        const double error = event_steps * statistics_.step;
        std::vector<ImpactMoment> all;
        for (const Candidate& c : candidates_)
            all.push_back(
                {c.tau, c.border, c.sticks, c.event, c.height != 0 ? error : infinity, 0, 0});
        return all;
    }

    std::vector<ImpactMoment> pulse_moments() const {
        std::vector<ImpactMoment> all;
        for (const Candidate& c : candidates_)
            all.push_back(
                {c.tau, c.border, c.sticks, c.pulse_tau, c.pulse_error,
                 c.is_impact() ? spoiled_.a.before : 0, c.is_impact() ? spoiled_.a.after : 0});
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
        const double late = event_delay();
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            Candidate& c = candidates_[i];
            if (!c.is_impact()) continue;
            const double other = c.height != 0 ? c.event - late : found_.fit.impacts[i].tau;
            const PulseMoment m =
                pulse_moment(found_.pulse, found_.fit, i, other, r_, bad_.a, statistics_.step);
            c.pulse_tau = m.tau, c.pulse_error = m.error;
        }
        values_[Unknown::pulse_lag] = 0;
    }

    /// Of the events behind their impacts.
    double event_delay() const {
        std::vector<double> late;
        for (const Candidate& c : candidates_)
            if (c.height != 0) late.push_back(c.event - c.tau);
        return late.empty() ? 0 : median(std::move(late));
    }

    void find_sides() {
        sides_.clear();
        for (std::size_t i = 0; i < candidates_.size(); ++i)
            sides_.push_back(candidates_[i].border == Border::gap ? 0 : side_of(i));
    }

    /// Once the impacts are known the mass tells more of their moments, and its R and b.
    void fit_with_mass() {
        JointFitInput with_mass = input(r_);
        with_mass.sides = &sides_;
        JointFit fit = found_.fit;
        for (int run = 0; run < most_runs_with_mass && !(run > 0 && fit.converged); ++run)
            fit = fit_jointly(with_mass, pulse_moments(), fit.values, &fit, progress_);
        mass_ = fit.values;
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
        if (!may_be_free_ || is_free ||
            (o_.fixed[Unknown::stiffness] && o_.fixed[Unknown::damping]))
            return false;
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
        if (!is_plausible(trial.values)) return false;
        fixed_ = o_.fixed;
        values_ = trial.values;
        return true;
    }

    bool is_plausible(const UnknownValues& v) const {
        const UnknownValues given = given_unknowns(p_);
        const double c = v[Unknown::damping], given_c = given[Unknown::damping];
        return std::abs(v[Unknown::stiffness] - given[Unknown::stiffness]) < most_of_stiffness &&
               c < most_of_damping * given_c + slack_of_damping &&
               c > given_c / most_of_damping - slack_of_damping;
    }

    /// An oscillator that is far from the given one is none: something else is wrong. Says whether
    /// it was so.
    bool return_to_given() {
        const bool is_free = !fixed_[Unknown::stiffness] || !fixed_[Unknown::damping];
        if (!is_free || is_plausible(values_)) return false;
        const UnknownValues given = given_unknowns(p_);
        may_be_free_ = false;
        fixed_[Unknown::stiffness] = fixed_[Unknown::damping] = true;
        values_[Unknown::stiffness] = given[Unknown::stiffness];
        values_[Unknown::damping] = given[Unknown::damping];
        changed_ = true;
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

    /// What no pulse shows, but the mass must do: impacts that are too weak, and the time for which
    /// it sticks. What the fit put there in their place is dropped. Says whether that changes
    /// anything.
    bool put_in_hidden() {
        if (!(mass_[Unknown::b] > 0)) return false;
        const bool searched = o_.moments.empty();
        std::vector<Candidate> shown;
        std::vector<IdentifiedImpact> impacts;
        std::vector<char> doubtful;
        const double ratio = jump_to_height(candidates_);
        std::vector<double> errors;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            if (candidates_[i].is_predicted()) continue;
            shown.push_back(candidates_[i]);
            shown.back().sticks = false;
            const FittedImpact& m = found_.fit.impacts[i];
            if (!candidates_[i].is_impact()) continue;
            impacts.push_back(
                {.tau = m.tau,
                 .side = sides_[i],
                 .x = m.x,
                 .x_dot_before = m.x_dot_before,
                 .x_dot_after = m.x_dot_after,
                 .x_ddot_before = m.x_ddot_before});
            const double promised = ratio * std::abs(candidates_[i].height);
            doubtful.push_back(
                searched && !(std::abs(std::abs(m.jump()) - promised) <
                              kept_promise * promised + 2 * m.x_dot_jump_error));
            errors.push_back(m.x_dot_jump_error);
        }
        const double error = median(errors), typical = typical_jump(candidates_);
        const IdentifiedSystem system(
            identified_parameters(), found_.fit.values, found_.fit.tau_middle);
        found_.hiding = {
            .tolerance = hidden_tolerance * typical,
            .longest = longest_flights * (r_.tau.back() - r_.tau.front()) /
                       static_cast<double>(impacts.size()),
            .most_seen = searched ? HidingPlaces{}.most_seen : 0,
            .gaps = found_.gaps};
        const std::vector<HiddenContacts> hidden =
            hidden_contacts(system, found_.hiding, impacts, doubtful);
        std::vector<Candidate> all = shown_candidates(shown, hidden);
        for (const HiddenContacts& h : hidden) add_hidden(h, impacts[h.from].side, error, all);
        sort_by_time(all);
        for (std::size_t i = 1; i < all.size(); ++i)
            if (all[i].border == Border::release) all[i - 1].sticks = true;
        const double least =
            hidden_rounds_++ == 0 ? 0 : few_changes * static_cast<double>(candidates_.size());
        changed_ = static_cast<double>(differences_to(all)) > least;
        if (changed_) candidates_ = std::move(all);
        return changed_;
    }

    Parameters identified_parameters() const {
        const UnknownValues& v = mass_;
        Parameters p = p_;
        p.Omega = v[Unknown::Omega];
        p.b = v[Unknown::b];
        p.R_plus = std::clamp(v[Unknown::R_plus], 0.0, 1.0);
        p.R_minus = std::clamp(v[Unknown::R_minus], 0.0, 1.0);
        return p;
    }

    /// Without those that the run has not where they are shown.
    static std::vector<Candidate> shown_candidates(
        const std::vector<Candidate>& shown, const std::vector<HiddenContacts>& hidden) {
        std::vector<Candidate> kept;
        auto next = hidden.begin();
        std::size_t impact = 0;
        for (const Candidate& c : shown) {
            if (!c.is_impact()) {
                kept.push_back(c);
                continue;
            }
            while (next != hidden.end() && next->to <= impact) ++next;
            const bool is_between = next != hidden.end() && impact > next->from;
            if (!is_between || std::any_of(
                                   next->impacts.begin(), next->impacts.end(),
                                   [&](const RunImpact& r) { return r.shown == impact; }))
                kept.push_back(c);
            ++impact;
        }
        return kept;
    }

    /// Those that are worth an interval of their own. Of the end of a chatter the centre of mass
    /// knows nothing: it moves as if both stuck together.
    /// `side`: of the impact before.
    void add_hidden(
        const HiddenContacts& h, int side, double error, std::vector<Candidate>& all) const {
        const auto release = [&](const std::optional<Release>& r, int wall) {
            if (r)
                all.push_back({.tau = r->tau, .border = Border::release, .predicted_side = wall});
        };
        release(h.release, side);
        double before = -infinity;
        for (const RunImpact& r : h.impacts) {
            const Impact& i = r.impact;
            const double jump = i.x_dot_after - i.x_dot_before;
            if (!r.shown && std::abs(jump) > error && i.tau - before > 3 * statistics_.step)
                all.push_back({.tau = i.tau, .jump = jump, .predicted_side = i.side});
            before = i.tau;
            release(r.release, i.side);
        }
    }

    /// How many of these are not among the candidates, or of those not among these.
    std::size_t differences_to(const std::vector<Candidate>& all) const {
        const auto same = [this](const Candidate& a, const Candidate& b) {
            return a.border == b.border && a.sticks == b.sticks &&
                   a.predicted_side == b.predicted_side &&
                   std::abs(a.tau - b.tau) < statistics_.step;
        };
        std::size_t matched = 0, i = 0, k = 0;
        while (i < all.size() && k < candidates_.size())
            if (same(all[i], candidates_[k])) ++matched, ++i, ++k;
            else all[i].tau < candidates_[k].tau ? ++i : ++k;
        return all.size() + candidates_.size() - 2 * matched;
    }

    /// The wall pushes x back; its pulse says so where the jump of x' does not.
    int side_of(std::size_t impact) const {
        const Candidate& c = candidates_[impact];
        if (c.is_predicted()) return c.predicted_side;
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
        std::vector<FittedImpact> impacts;
        for (std::size_t i = 0; i < candidates_.size(); ++i) {
            if (!candidates_[i].is_impact() || candidates_[i].is_predicted()) continue;
            impacts.push_back(found_.fit.impacts[i]);
            found_.side.push_back(sides_[i]);
        }
        found_.fit.impacts = std::move(impacts);
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
    UnknownValues mass_{};  // b and R by the last fit with the mass, converged or not
    Sides sides_;
    SpoiledExtents spoiled_;
    std::vector<Candidate> candidates_;
    struct Rejected {
        double tau;
        bool is_shown;  ///< by a pulse, or given
    };
    std::vector<Rejected> rejected_;
    int rounds_ = 0, hidden_rounds_ = 0;
    bool may_be_free_ = true;  // the oscillator
    bool changed_ = true;      // the candidates, since the last fit
    FoundImpacts found_;
};

}  // namespace

FoundImpacts find_impacts(
    const Parameters& p, const MeasuredRecord& r, const SearchOptions& o,
    IdentificationProgress& progress) {
    return Search(p, r, o, progress).take();
}

}  // namespace vines
