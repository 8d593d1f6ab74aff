#include "core/measurement/hidden_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

/// The forcing as a load of a run whose time starts at the excess' begin and runs `faster`.
Load load_of(const LoadResponse::Excess& excess, const UnknownValues& v, double faster) {
    using Complex = std::complex<double>;
    const Complex amplitude(v[Unknown::force_cos], -v[Unknown::force_sin]);
    const double step = 0.5 * excess.step, square = faster * faster;
    std::vector<LoadNode> nodes;
    for (std::size_t n = 0; n < excess.at.size(); ++n) {
        const auto sine =
            elementary::phasor(v[Unknown::Omega] * (excess.begin + step * static_cast<double>(n)));
        // Differences of fourth order; the outermost nodes lie beyond the record.
        const Complex* at = &excess.at[std::clamp<std::size_t>(n, 2, excess.at.size() - 3)];
        const Complex rate = (8.0 * (at[1] - at[-1]) - (at[2] - at[-2])) / (12 * step);
        nodes.push_back(
            {(amplitude * (sine + excess.at[n])).real() / square,
             (amplitude * (Complex(0, v[Unknown::Omega]) * sine + rate)).real() /
                 (square * faster)});
    }
    return {faster * step, nodes};
}

// Largest distance between an impact of the run and the measured one: tau, plus this share of time.
constexpr double same_moment = 0.1, same_share = 0.01;
constexpr double same_jump = 0.2;  // tolerance of the jump of x', relative
// A doubtful impact can be an artefact of hidden contacts within this tau.
constexpr double artefact_range = 0.5;
// A run continues over impacts weaker than this many tolerances: it is more precise than they are.
constexpr double strong = 6;
// The impacts at the end of a chatter below this many tolerances are reported as one.
constexpr double weakest_reported = 0.4;
// Longest run over hidden contacts, in typical flights: anything longer is a gap.
constexpr double longest_flights = 40;
constexpr long most_impacts = 120;  // limit for one run: a chatter has about fifty impacts
// The search ends when this many more runs failed than succeeded: the system is another one.
constexpr int many_runs = 100;

/// Records the contacts of a run from `tau` on, in the measurement's units.
struct RunContacts : Observer {
    const IdentifiedSystem& system;
    const double tau;
    std::optional<Release> stuck = {}, release = {};  // release: from the start
    std::vector<RunImpact> impacts = {};

    RunContacts(const IdentifiedSystem& s, double from) : system(s), tau(from) {}

    void on_impact(const Impact& of_run) override {
        impacts.push_back({listed(system.measured(of_run, tau))});
        impacts.back().is_hidden = true;
    }
    void on_stretch(const Stretch& s) override {
        if (s.sticking_side == 0) return;
        const State end = s.at(s.duration);
        const double at = system.measured_time(s.tau + s.duration, tau);
        stuck = Release{at, end.x, end.x_dot * system.faster};
    }
    void on_release(double) override {
        if (stuck) (impacts.empty() ? release : impacts.back().release) = stuck;
        stuck.reset();
    }
};

struct HiddenContactSearch {
    const IdentifiedSystem& system;
    const HiddenContactLimits& limits;
    const IdentifiedImpacts& impacts;
    const std::vector<char>& doubtful;

    std::vector<HiddenContacts> find(const Look& look) const {
        std::vector<HiddenContacts> all;
        // y' before the impact according to the run that reached it; more precise than the flight.
        double y_dot_before = nan;
        int led = 0, failed = 0;
        for (std::size_t i = 0; i + 1 < impacts.size() && failed < many_runs + led;) {
            look();
            std::size_t next = i + 1;
            if (std::isnan(y_dot_before) && i > 0) y_dot_before = flight_end(i);
            const std::vector<Velocities> possible = velocities_after(i, y_dot_before);
            y_dot_before = nan;
            for (const Velocities& after : possible) {
                // Takes the first velocities whose run reaches an impact.
                auto found = between(i, after);
                found ? ++led : ++failed;
                if (!found) continue;
                next = found->to;
                if (hides(*found)) {
                    find_ends(*found);
                    y_dot_before = found->y_dot_before;
                    all.push_back(std::move(*found));
                }
                break;
            }
            i = next;
        }
        return all;
    }

    /// y' at the end of the flight to impact i.
    double flight_end(std::size_t i) const {
        const IdentifiedImpact &from = impacts[i - 1], &to = impacts[i];
        const double braked = system.faster * system.faster * braking(system.own, from, to);
        return flight_velocity(system.own.b, from, to) - braked;
    }

    /// Marks the last impacts of each chatter that ends in a sticking phase.
    void find_ends(HiddenContacts& h) const {
        bool rests = false;
        for (std::size_t k = h.impacts.size(); k-- > 0;) {
            RunImpact& r = h.impacts[k];
            rests = r.release || (rests && r.side == h.impacts[k + 1].side);
            rests = rests && !r.shown && std::abs(r.jump()) < weakest_reported * limits.tolerance;
            r.comes_to_rest = rests;
        }
    }

    /// Whether the run has contacts that are not measured, or lacks measured ones.
    static bool hides(const HiddenContacts& h) {
        return h.release || h.to - h.from != h.impacts.size() + 1 ||
               std::ranges::any_of(
                   h.impacts, [](const RunImpact& r) { return r.release || !r.shown; });
    }

    /// Whether measured impact i can be an artefact of hidden contacts nearby.
    bool stands_for(std::size_t i, const HiddenContacts& hidden) const {
        if (doubtful.empty() || !doubtful[i]) return false;
        const double tau = impacts[i].tau;
        const auto near = [&](double from, const std::optional<Release>& r) {
            return tau > from - artefact_range && tau < (r ? r->tau : from) + artefact_range;
        };
        return near(impacts[hidden.from].tau, hidden.release) ||
               std::ranges::any_of(
                   hidden.impacts, [&](const RunImpact& h) { return near(h.tau, h.release); });
    }

    struct Velocities {
        double x_dot, y_dot;
    };
    /// Possible velocities after an impact that the mass reaches with y' = `y_dot_before`, most
    /// reliable first: contacts hidden soon after it can affect its jump, but nothing before it.
    std::vector<Velocities> velocities_after(std::size_t i, double y_dot_before) const {
        const IdentifiedImpact& m = impacts[i];
        const Parameters& p = system.own;
        const auto R_at = [&](double speed) { return p.restitution(m.side, std::abs(speed)); };
        const auto share = [&](double R) { return p.epsilon * (1 + R) / (1 + p.epsilon); };
        std::vector<Velocities> all;
        const double met = m.x_dot_before - y_dot_before, R_met = R_at(met),
                     x_dot = m.x_dot_before - share(R_met) * met;
        if (m.side * met > 0) all.push_back({x_dot, x_dot + R_met * met});
        // R depends little on the speed.
        const double jump = m.x_dot_before - m.x_dot_after,
                     R_meets = R_at(jump / share(R_at(jump / p.epsilon))),
                     meets = jump / share(R_meets);
        if (m.side * meets > 0) all.push_back({m.x_dot_after, m.x_dot_after + R_meets * meets});
        return all;
    }

    /// Latest end of a run from `tau`.
    double end_after(double tau) const {
        const double end = std::min(
            tau + longest_flights * limits.typical_flight, impacts.back().tau + same_moment);
        const auto gap = std::ranges::upper_bound(limits.gaps, tau, {}, &Interval::to);
        return gap == limits.gaps.end() ? end : std::min(end, gap->from);
    }

    /// Contacts between an impact and the next one that the run reaches; prefers a strong one.
    std::optional<HiddenContacts> between(std::size_t from, const Velocities& after) const {
        const double tau = impacts[from].tau, to = impacts[from + 1].tau, end = end_after(tau),
                     next = std::min(end, may_be_apart(tau, to) + to);
        // Most runs reach the very next impact.
        auto near = between(from, after, next);
        if (end <= next || (near && is_strong(near->to))) return near;
        auto far = between(from, after, end);
        return far && (!near || is_strong(far->to)) ? far : near;
    }
    std::optional<HiddenContacts> between(
        std::size_t from, const Velocities& after, double end) const {
        const IdentifiedImpact& first = impacts[from];
        if (!(end > first.tau)) return std::nullopt;
        RunContacts run(system, first.tau);
        const double y = first.x - first.side * system.own.b;
        system.run(
            first.tau, {after.x_dot, first.x, after.y_dot, y},
            {.tau_end = end, .max_impacts = most_impacts}, {&run});
        HiddenContacts hidden{from, from, after.y_dot, nan, run.release};
        std::optional<HiddenContacts> found;
        std::size_t shown = from + 1;
        int unseen = 0;
        for (std::size_t n = 0; n < run.impacts.size(); ++n) {
            RunImpact& next = run.impacts[n];
            // In a chatter the measured impact belongs to the nearest one of the run.
            const bool repeats = n + 1 < run.impacts.size() && run.impacts[n + 1].side == next.side;
            const double following = repeats ? run.impacts[n + 1].tau : infinity;
            const double apart = may_be_apart(first.tau, next.tau);
            for (; shown < impacts.size() && impacts[shown].tau < next.tau - apart; ++shown)
                // The run has no impact where one is measured.
                if (!stands_for(shown, hidden)) return found;
            if (shown == impacts.size()) return found;
            const IdentifiedImpact& m = impacts[shown];
            const bool is_there = m.tau < next.tau + apart && m.side == next.side &&
                                  m.tau - next.tau < following - m.tau;
            if (is_there && leads_to(hidden, after.x_dot, m, next)) {
                if (is_strong(shown) || !found) {
                    found = hidden;
                    found->to = shown, found->y_dot_before = next.y_dot_before;
                }
                if (is_strong(shown)) return found;
            }
            if (is_there) next.shown = shown++;
            else if (std::abs(next.jump()) > limits.tolerance && ++unseen > limits.most_seen)
                return found;
            hidden.impacts.push_back(next);
        }
        return found;
    }

    bool is_strong(std::size_t i) const {
        return std::abs(impacts[i].jump()) > strong * limits.tolerance;
    }
    /// Largest distance between an impact of the run and the measured one.
    static double may_be_apart(double from, double to) {
        return same_moment + same_share * (to - from);
    }

    /// Whether the next impact of the run agrees with the measured one, and the free motion from
    /// the last contact leads to its state. `x_dot`: after the first impact.
    bool leads_to(
        const HiddenContacts& hidden, double x_dot, const IdentifiedImpact& shown,
        const RunImpact& next) const {
        const double off = std::abs(next.jump() - shown.jump());
        if (off > limits.tolerance + same_jump * std::abs(shown.jump())) return false;
        const IdentifiedImpact& from = impacts[hidden.from];
        Release last{from.tau, from.x, x_dot};
        int side = from.side;
        if (hidden.release) last = *hidden.release;
        if (!hidden.impacts.empty()) {
            const RunImpact& h = hidden.impacts.back();
            side = h.side;
            last = h.release.value_or(Release{h.tau, h.x, h.x_dot_after});
        }
        if (!(last.tau < shown.tau)) return false;
        const OscillatorMotion end = system.free_motion(last, side, shown.tau, shown.side);
        return std::abs(end.x - shown.x) < limits.tolerance &&
               std::abs(end.x_dot - shown.x_dot_before) < limits.tolerance;
    }
};

}  // namespace

IdentifiedSystem::IdentifiedSystem(
    const Parameters& p, const UnknownValues& v, double tau_zero, const MeasuredLoad* load)
    : values(v),
      flows(v, false, p.epsilon, load),
      own(p),
      faster(std::sqrt(v[Unknown::stiffness])),
      tau_zero(tau_zero) {
    own.Omega /= faster;
    own.lambda = std::max(0.0, v[Unknown::damping] / (faster * p.epsilon)) /
                 (p.damping == Damping::closed_form ? 2 : 1);
    own.G = G_of(own, v[Unknown::force_sin], v[Unknown::force_cos]) / (faster * faster);
    own.friction /= faster * faster;
    for (auto* table : {&own.table_plus, &own.table_minus})
        if (*table)
            *table = std::make_shared<const RestitutionTable>(RestitutionTable{
                values_of((*table)->speed, [&](double w) { return w / faster; }), (*table)->R});
    if (!flows.excess) return;
    own.G = 0;
    own.load = std::make_shared<const Load>(load_of(*flows.excess, v, faster));
}

IdentifiedSystem::IdentifiedSystem(const Parameters& p, const ListedForcing& forcing)
    : IdentifiedSystem(p, given_unknowns(p, forcing.sin, forcing.cos), 0, nullptr) {}

// simulate() counts the forcing's phase from eq. (3); the measurement has its own phase.
double IdentifiedSystem::start_of(double tau) const {
    if (flows.excess) return faster * (tau - tau_zero - flows.excess->begin);
    return std::fmod(
        faster * (tau - tau_zero) + (flows.free.phase - own.phi()) / own.Omega, own.cycle());
}

Outcome IdentifiedSystem::run(
    double tau, const State& s, Limits limits, std::initializer_list<Observer*> observers) const {
    limits.tau_start = start_of(tau);
    limits.tau_end = limits.tau_start + faster * (limits.tau_end - tau);
    return simulate(own, {s.x_dot / faster, s.x, s.y_dot / faster, s.y}, limits, observers);
}

OscillatorMotion IdentifiedSystem::free_motion(
    const Release& from, int from_side, double tau, int to_side) const {
    const double pull = faster * faster * own.epsilon * own.friction;
    const FittedInterval interval{
        from.tau, from.x, from.x_dot, false, Sliding::between(from_side, to_side), pull};
    return IntervalMotion(flows.free, values, tau_zero, interval).at(tau - from.tau, false).value;
}

Impact IdentifiedSystem::measured(Impact i, double tau) const {
    i.tau = measured_time(i.tau, tau);
    for (double* v :
         {&i.x_dot_before, &i.x_dot_after, &i.y_dot_before, &i.y_dot_after,
          &i.relative_speed_before, &i.relative_speed_after})
        *v *= faster;
    i.x_ddot_before *= faster * faster;
    return i;
}

std::vector<HiddenContacts> hidden_contacts(
    const IdentifiedSystem& system, const HiddenContactLimits& limits,
    const IdentifiedImpacts& impacts, const std::vector<char>& doubtful, const Look& look) {
    return HiddenContactSearch{system, limits, impacts, doubtful}.find(look);
}

void insert_hidden(const std::vector<HiddenContacts>& hidden, IdentifiedImpacts& impacts) {
    IdentifiedImpacts all;
    auto next = hidden.begin();
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        all.push_back(impacts[i]);
        if (next == hidden.end() || next->from != i) continue;
        all.back().release = next->release;
        all.back().y_dot_after = next->y_dot_after;
        for (const RunImpact& r : next->impacts) {
            IdentifiedImpact& last = all.emplace_back(r);
            if (r.shown) last = impacts[*r.shown];
            last.y_dot_before = r.y_dot_before, last.y_dot_after = r.y_dot_after;
            last.release = r.release, last.comes_to_rest = r.comes_to_rest;
        }
        i = next->to - 1;
        impacts[next->to].y_dot_before = next->y_dot_before;
        ++next;
    }
    impacts = std::move(all);
}

}  // namespace vines
