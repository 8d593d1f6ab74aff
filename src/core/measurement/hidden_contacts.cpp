#include "core/measurement/hidden_contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// A contact of a run is an impact that is shown if no more tau lies between them.
constexpr double same_moment = 0.1, same_share = 0.01;
// Nor is its jump of x' off by more than that share.
constexpr double same_jump = 0.2;
// An impact that is shown may stand for those that are hidden no farther from it.
constexpr double beside = 0.5;
// A run goes on over impacts that are weaker than so many tolerances: they tell it less than it
// knows.
constexpr double strong = 6;
// Of a chatter that comes to rest the impacts below that many tolerances are told as one.
constexpr double weakest_told = 0.4;
// Of a run: a chatter that comes to rest has some fifty.
constexpr long most_impacts = 120;
// Where that many runs, and most of them, lead nowhere, the system is not the one that is measured.
constexpr int many_runs = 100;

/// The contacts of a run, in its own tau.
class Contacts : public Observer {
public:
    void on_impact(const Impact& i) override { impacts.push_back({i}); }
    void on_stretch(const Stretch& s) override {
        if (s.stuck_side != 0) {
            const Oscillation end = s.flow.after(s.start, s.duration);
            stuck_ = Release{s.tau + s.duration, end.x, end.x_dot};
        }
    }
    void on_release(double) override {
        if (stuck_) (impacts.empty() ? release : impacts.back().release) = stuck_;
        stuck_.reset();
    }

    std::optional<Release> release;  // from the start
    std::vector<RunImpact> impacts;

private:
    std::optional<Release> stuck_;
};

class Finder {
public:
    Finder(
        const IdentifiedSystem& system, const HidingPlaces& places,
        const std::vector<IdentifiedImpact>& impacts, const std::vector<char>& doubtful)
        : system_(system),
          places_(places),
          impacts_(impacts),
          doubtful_(doubtful) {}

    std::vector<HiddenContacts> find(const std::function<void()>& look) const {
        std::vector<HiddenContacts> all;
        // The run that leads to an impact knows better than the flight what comes to it.
        double comes = nan;
        int led = 0, failed = 0;
        for (std::size_t i = 0; i + 1 < impacts_.size() && failed < many_runs + led;) {
            if (look) look();
            std::size_t next = i + 1;
            if (std::isnan(comes) && i > 0)
                comes = flight_velocity(system_.own().b, impacts_[i - 1], impacts_[i]);
            const std::vector<Velocities> ways = velocities_after(i, comes);
            comes = nan;
            for (const Velocities& after : ways) {
                // The first one that the run leads to by one way is trusted.
                auto found = between(i, after);
                found ? ++led : ++failed;
                if (!found) continue;
                next = found->to;
                if (hides(*found)) {
                    find_ends(*found);
                    comes = found->y_dot_before;
                    all.push_back(std::move(*found));
                }
                break;
            }
            i = next;
        }
        return all;
    }

private:
    /// The last impacts of each chatter that comes to rest.
    void find_ends(HiddenContacts& h) const {
        bool rests = false;
        for (std::size_t k = h.impacts.size(); k-- > 0;) {
            RunImpact& r = h.impacts[k];
            rests = r.release || (rests && r.impact.side == h.impacts[k + 1].impact.side);
            rests = rests && !r.shown && strength(r.impact) < weakest_told * places_.tolerance;
            r.comes_to_rest = rests;
        }
    }

    /// Whether anything, or what is shown is not there.
    static bool hides(const HiddenContacts& h) {
        return h.release || h.to - h.from != h.impacts.size() + 1 ||
               std::any_of(h.impacts.begin(), h.impacts.end(), [](const RunImpact& r) {
                   return r.release || !r.shown;
               });
    }

    bool is_firm(std::size_t i) const { return doubtful_.empty() || !doubtful_[i]; }
    /// Whether an impact that is shown stands for what is hidden beside it.
    bool stands_for(std::size_t i, const HiddenContacts& hidden) const {
        if (is_firm(i)) return false;
        const double tau = impacts_[i].tau;
        const auto near = [&](double from, const std::optional<Release>& r) {
            return tau > from - beside && tau < (r ? r->tau : from) + beside;
        };
        return near(impacts_[hidden.from].tau, hidden.release) ||
               std::any_of(hidden.impacts.begin(), hidden.impacts.end(), [&](const RunImpact& h) {
                   return near(h.impact.tau, h.release);
               });
    }

    struct Velocities {
        double x_dot, y_dot;
    };
    /// After an impact to which the mass comes so, most trusted first. The motion before it, and
    /// the flight, know nothing of what may be hidden soon after it; its jump may be wrong by that.
    std::vector<Velocities> velocities_after(std::size_t i, double comes) const {
        const IdentifiedImpact& m = impacts_[i];
        const Parameters& p = system_.own();
        const double R = p.restitution(m.side), share = p.epsilon * (1 + R) / (1 + p.epsilon),
                     meets = (m.x_dot_before - m.x_dot_after) / share;
        std::vector<Velocities> all;
        const double met = m.x_dot_before - comes, x_dot = m.x_dot_before - share * met;
        if (m.side * met > 0) all.push_back({x_dot, x_dot + R * met});
        if (m.side * meets > 0) all.push_back({m.x_dot_after, m.x_dot_after + R * meets});
        return all;
    }

    /// The end of the longest run from a moment.
    double end_after(double tau) const {
        const double end = std::min(tau + places_.longest, impacts_.back().tau + same_moment);
        const auto gap = std::upper_bound(
            places_.gaps.begin(), places_.gaps.end(), tau,
            [](double t, const TimeGap& g) { return t < g.to; });
        return gap == places_.gaps.end() ? end : std::min(end, gap->from);
    }

    /// What comes between an impact, which both masses leave so, and the next one that is shown, if
    /// the run leads to one; to a strong one, if it can.
    std::optional<HiddenContacts> between(std::size_t from, const Velocities& after) const {
        const double tau = impacts_[from].tau, end = end_after(tau),
                     next = std::min(
                         end, may_be_apart(tau, impacts_[from + 1].tau) + impacts_[from + 1].tau);
        // Most lead to the very next one.
        auto near = between(from, after, next);
        if (end <= next || (near && is_strong(near->to))) return near;
        auto far = between(from, after, end);
        return far && (!near || is_strong(far->to)) ? far : near;
    }
    std::optional<HiddenContacts> between(
        std::size_t from, const Velocities& after, double end) const {
        const IdentifiedImpact& m = impacts_[from];
        if (!(end > m.tau)) return std::nullopt;
        Contacts run;
        Observer* const observers[] = {&run};
        system_.run(
            m.tau, {after.x_dot, m.x, after.y_dot, m.x - m.side * system_.own().b},
            {.tau_end = end, .max_impacts = most_impacts}, observers);
        HiddenContacts hidden{from, from, after.y_dot, nan, measured(run.release, m.tau)};
        std::optional<HiddenContacts> found;
        std::size_t shown = from + 1;
        int unseen = 0;
        for (const RunImpact& of_run : run.impacts) {
            RunImpact next{system_.measured(of_run.impact, m.tau), measured(of_run.release, m.tau)};
            const double apart = may_be_apart(m.tau, next.impact.tau);
            for (; shown < impacts_.size() && impacts_[shown].tau < next.impact.tau - apart;
                 ++shown)
                // It does not come where it is shown.
                if (!stands_for(shown, hidden)) return found;
            if (shown == impacts_.size()) return found;
            const bool is_there = impacts_[shown].tau < next.impact.tau + apart &&
                                  impacts_[shown].side == next.impact.side;
            if (is_there && leads_to(hidden, after.x_dot, impacts_[shown], next.impact)) {
                if (is_strong(shown) || !found) {
                    found = hidden;
                    found->to = shown, found->y_dot_before = next.impact.y_dot_before;
                }
                if (is_strong(shown)) return found;
            }
            if (is_there) next.shown = shown++;
            else if (strength(next.impact) > places_.tolerance && ++unseen > places_.most_seen)
                return found;
            hidden.impacts.push_back(next);
        }
        return found;
    }

    bool is_strong(std::size_t i) const {
        return std::abs(impacts_[i].x_dot_after - impacts_[i].x_dot_before) >
               strong * places_.tolerance;
    }
    /// By how much a run's contact and one that is shown may be.
    static double may_be_apart(double from, double to) {
        return same_moment + same_share * (to - from);
    }
    static double strength(const Impact& i) { return std::abs(i.x_dot_after - i.x_dot_before); }

    std::optional<Release> measured(const std::optional<Release>& r, double tau) const {
        if (!r) return r;
        return Release{system_.moment(r->tau, tau), r->x, r->x_dot * system_.faster()};
    }

    /// Whether the next impact of the run is like the one that is shown, and the oscillator comes
    /// from what was last to its state. `x_dot`: after the first one.
    bool leads_to(
        const HiddenContacts& hidden, double x_dot, const IdentifiedImpact& shown,
        const Impact& next) const {
        const double jump = shown.x_dot_after - shown.x_dot_before;
        if (std::abs(next.x_dot_after - next.x_dot_before - jump) >
            places_.tolerance + same_jump * std::abs(jump))
            return false;
        const IdentifiedImpact& from = impacts_[hidden.from];
        Release last{from.tau, from.x, x_dot};
        if (hidden.release) last = *hidden.release;
        if (!hidden.impacts.empty()) {
            const RunImpact& h = hidden.impacts.back();
            last = h.release ? *h.release : Release{h.impact.tau, h.impact.x, h.impact.x_dot_after};
        }
        if (!(last.tau < shown.tau)) return false;
        const OscillatorMotion end = system_.free_motion(last, shown.tau);
        return std::abs(end.x - shown.x) < places_.tolerance &&
               std::abs(end.x_dot - shown.x_dot_before) < places_.tolerance;
    }

    const IdentifiedSystem& system_;
    const HidingPlaces& places_;
    const std::vector<IdentifiedImpact>& impacts_;
    const std::vector<char>& doubtful_;
};

IdentifiedImpact as_identified(const RunImpact& r) {
    const Impact& i = r.impact;
    return {
        .tau = i.tau,
        .side = i.side,
        .x = i.x,
        .x_dot_before = i.x_dot_before,
        .x_dot_after = i.x_dot_after,
        .x_ddot_before = i.x_ddot_before,
        .is_hidden = true};
}

}  // namespace

std::vector<HiddenContacts> hidden_contacts(
    const IdentifiedSystem& system, const HidingPlaces& places,
    const std::vector<IdentifiedImpact>& impacts, const std::vector<char>& doubtful,
    const std::function<void()>& look) {
    return Finder(system, places, impacts, doubtful).find(look);
}

long put_in(const std::vector<HiddenContacts>& hidden, std::vector<IdentifiedImpact>& impacts) {
    std::vector<IdentifiedImpact> all;
    auto next = hidden.begin();
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        all.push_back(impacts[i]);
        if (next == hidden.end() || next->from != i) continue;
        all.back().release = next->release;
        all.back().y_dot_after = next->y_dot_after;
        for (const RunImpact& r : next->impacts) {
            all.push_back(r.shown ? impacts[*r.shown] : as_identified(r));
            IdentifiedImpact& last = all.back();
            last.y_dot_before = r.impact.y_dot_before, last.y_dot_after = r.impact.y_dot_after;
            last.release = r.release, last.comes_to_rest = r.comes_to_rest;
        }
        i = next->to - 1;
        impacts[next->to].y_dot_before = next->y_dot_before;
        ++next;
    }
    const auto added = static_cast<long>(all.size() - impacts.size());
    impacts = std::move(all);
    return added;
}

}  // namespace vines
