#include "core/measures/regime.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// Fig. 9's synchronised parts: at b = 34 and 40 mm there are none, at 31 mm and below there are
// (shared border of Types I and II); the border does not move between 10 and 20 %.
constexpr double synchrony_tolerance = 0.15;
// Two impacts per cycle over two cycles: a shorter alternation happens by chance.
constexpr long shortest_stretch = 4;
constexpr int moving_cycles = 10;
// A period that the run may have closed: in cycles.
constexpr std::size_t longest_period = 512;
// States that differ by less, in units of their scale, may be a return; Newton's method decides. A
// run that is chaotic by its exponents comes as close as that by chance, all the time.
constexpr double near_return = 0.1, near_return_of_chaos = 1e-3;
// So many returns are tried, the first one whatever its length, the others while they add up to so
// many cycles.
constexpr int most_attempts = 8;
constexpr std::size_t most_attempted_cycles = 1024;
// Of an irregular response z is a mean over a finite run.
constexpr double irregular_margin = 0.02;
// How far a run that is near a return but not on an orbit is followed further, in cycles, round by
// round.
constexpr int follow_rounds[] = {150, 300, 600, 1200};
// A run of whole cycles goes on by this share, so that the rounding of its end does not cut off the
// last of them.
constexpr double past_last_cycle = 1e-12;
// A run has been captured once it stays this close to the orbit.
constexpr double captured_within = 0.1;

std::vector<CountedContact> within(const std::vector<CountedContact>& all, double from, double to) {
    const auto before = [](const CountedContact& c, double tau) { return c.tau < tau; };
    const auto first = std::lower_bound(all.begin(), all.end(), from, before);
    return {first, std::lower_bound(first, all.end(), std::nextafter(to, infinity), before)};
}

/// A phase of the forcing cycle that contacts stay away from, as a share of the cycle: there cycles
/// are cut for counting.
double quiet_phase(const std::vector<CountedContact>& contacts, double cycle) {
    constexpr int bins = 64;
    std::array<long, bins> count{};
    for (const CountedContact& c : contacts)
        ++count[std::min(
            bins - 1, static_cast<int>((c.tau / cycle - std::floor(c.tau / cycle)) * bins))];
    // The middle of the longest run of bins with the fewest contacts (a run may go over the end).
    const long fewest = *std::min_element(count.begin(), count.end());
    int best = 0, best_length = 0;
    for (int from = 0; from < bins; ++from) {
        int length = 0;
        while (length < bins && count[(from + length) % bins] == fewest) ++length;
        if (length > best_length) best = from, best_length = length;
    }
    return (best + 0.5 * best_length) / bins;
}

void count_cycles(
    Regime& r, const std::vector<CountedContact>& contacts, double cycle, double from, double to) {
    const double cut = contacts.empty() ? 0 : quiet_phase(contacts, cycle);
    const long first = static_cast<long>(std::ceil(from / cycle - cut)),
               last = static_cast<long>(std::floor(to / cycle - cut));
    if (last <= first) return;
    std::vector<int> per_cycle(last - first, 0);
    for (const CountedContact& c : contacts) {
        const double k = std::floor(c.tau / cycle - cut) - first;
        if (k >= 0 && k < per_cycle.size()) ++per_cycle[static_cast<std::size_t>(k)];
    }
    r.cycles_with.assign(*std::max_element(per_cycle.begin(), per_cycle.end()) + 1, 0);
    for (int n : per_cycle) ++r.cycles_with[n];
    for (double& share : r.cycles_with) share /= static_cast<double>(per_cycle.size());
    long sum = 0;
    for (std::size_t k = 0; k < per_cycle.size(); ++k) {
        sum += per_cycle[k] - (k >= moving_cycles ? per_cycle[k - moving_cycles] : 0);
        if (k + 1 < moving_cycles) continue;
        r.moving_tau.push_back(
            (first + static_cast<long>(k) + 1 + cut - 0.5 * moving_cycles) * cycle);
        r.moving_z.push_back(static_cast<double>(sum) / moving_cycles);
    }
}

/// How often the masses meet in the window.
void count_contacts(
    Regime& r, const std::vector<CountedContact>& contacts, double cycle, const RegimeEvidence& e) {
    r.contacts = static_cast<long>(contacts.size());
    if (r.contacts > 1)
        r.z_overall = static_cast<double>(r.contacts - 1) * cycle /
                      (contacts.back().tau - contacts.front().tau);
    else if (e.tau_end > e.tau_start)
        r.z_overall = static_cast<double>(r.contacts) * cycle / (e.tau_end - e.tau_start);
    r.z = r.z_overall;
    count_cycles(
        r, contacts, cycle, contacts.empty() ? e.tau_start : contacts.front().tau - cycle,
        e.tau_end);
}

/// Those at whole cycles up to tau_end.
std::span<const State> states_before(const StroboscopicRecord& record, double tau_end) {
    std::size_t end = record.states.size();
    while (end > 0 && record.tau(end - 1) > tau_end) --end;
    return std::span(record.states).first(end);
}

void find_stretches(Regime& r, const std::vector<CountedContact>& c, double half_cycle) {
    const std::size_t n = c.size();
    auto in_step = [&](std::size_t i) {
        return c[i + 1].side != c[i].side &&
               std::abs(c[i + 1].tau - c[i].tau - half_cycle) < synchrony_tolerance * half_cycle;
    };
    std::size_t free_from = 0;  // the first contact that no stretch has yet
    long in_stretches = 0;
    auto desynchronised = [&](std::size_t to) {
        if (to > free_from)
            r.stretches.push_back(
                {c[free_from].tau, c[to].tau, false, static_cast<long>(to - free_from) + 1});
    };
    for (std::size_t i = 0; i + 1 < n;) {
        std::size_t end = i;
        while (end + 1 < n && in_step(end)) ++end;
        const long half_cycles = static_cast<long>(end - i);
        r.longest_synchronised = std::max(r.longest_synchronised, half_cycles);
        if (half_cycles >= shortest_stretch) {
            desynchronised(i);
            r.stretches.push_back({c[i].tau, c[end].tau, true, half_cycles + 1});
            in_stretches += half_cycles + 1;
            free_from = end;
        }
        i = std::max(end, i + 1);
    }
    if (n > 0) {
        desynchronised(n - 1);
        r.synchronised = static_cast<double>(in_stretches) / static_cast<double>(n);
    }
}

/// Numbers of cycles after which the last state may have returned: the closest returns first; of
/// those that are about equally close, as all multiples of a period are, the shortest.
std::vector<std::size_t> returns(std::span<const State> states, const State& scale, double near) {
    constexpr double rounding = 1e-10;  // closer than this all are equally close
    struct Return {
        int decade;
        std::size_t cycles;
    };
    std::vector<Return> found;
    const std::size_t last = states.size() - 1;
    for (std::size_t cycles = 1; cycles <= std::min(longest_period, last); ++cycles) {
        const std::size_t back = last - cycles;
        const double miss = distance(states[last], states[back], scale);
        if (miss > near ||
            (back > 0 && distance(states[last - 1], states[back - 1], scale) > 2 * near))
            continue;
        int decade = 0;
        for (double next = 10 * rounding; miss >= next; next *= 10) ++decade;
        found.push_back({decade, cycles});
    }
    std::stable_sort(found.begin(), found.end(), [](const Return& a, const Return& b) {
        return a.decade < b.decade;
    });
    std::vector<std::size_t> cycles;
    for (const Return& r : found) cycles.push_back(r.cycles);
    return cycles;
}

/// The attracting periodic orbit that the last of the states is next to. `tried` tells whether a
/// return came close, so that there may be an orbit.
std::optional<PeriodicOrbit> orbit_at_end(
    const Parameters& p, std::span<const State> states, const State& scale, double near,
    const std::function<bool()>& stop, bool& tried) {
    int attempts = 0;
    std::size_t attempted = 0;
    for (const std::size_t cycles : returns(states, scale, near)) {
        if (attempts > 0 &&
            (attempts == most_attempts || attempted + cycles > most_attempted_cycles))
            break;
        ++attempts;
        attempted += cycles;
        tried = true;
        const auto orbit =
            find_orbit(p, states.back(), static_cast<int>(cycles), scale, 5 * near_return, stop);
        if (orbit && attracts(p, *orbit, states.back(), scale, stop)) return orbit;
        if (stop && stop()) break;
    }
    return std::nullopt;
}

/// Which of the orbit's states at whole cycles is next to a state.
std::size_t phase_of(const State& s, std::span<const State> along, const State& scale) {
    std::size_t best = 0;
    for (std::size_t k = 1; k < along.size(); ++k)
        if (distance(s, along[k], scale) < distance(s, along[best], scale)) best = k;
    return best;
}

/// As orbit_at_end(). A run may end while it slowly leaves an unstable orbit for a stable one
/// nearby, to which Newton's method does not go from there: then the motion is followed on, and an
/// orbit found later counts if the run's end was next to it already.
std::optional<PeriodicOrbit> orbit_of(
    const Parameters& p, std::span<const State> states, const State& scale,
    const RegimeEvidence& e) {
    const bool chaotic = e.by_exponents == Verdict::chaotic;
    bool tried = false;
    if (auto orbit = orbit_at_end(
            p, states, scale, chaotic ? near_return_of_chaos : near_return, e.stop, tried))
        return orbit;
    if (chaotic) return std::nullopt;
    State s = states.back();
    for (const int cycles : follow_rounds) {
        if (!tried) return std::nullopt;
        StroboscopicRecord on(p);
        Observer* const observers[] = {&on};
        if (!follow(p, s, 0, cycles * p.cycle() * (1 + past_last_cycle), e.stop, observers))
            return std::nullopt;
        s = on.states.back();
        tried = false;
        auto orbit = orbit_at_end(p, on.states, scale, near_return, e.stop, tried);
        if (!orbit) continue;
        const auto along = whole_cycle_states(p, *orbit);
        if (distance(states.back(), along[phase_of(states.back(), along, scale)], scale) <
            2 * captured_within)
            return orbit;
        return std::nullopt;
    }
    return std::nullopt;
}

/// The first whole cycle from which on the run stays next to the orbit; none where it is not there
/// at its end.
std::optional<std::size_t> captured_from(
    const Parameters& p, const PeriodicOrbit& orbit, std::span<const State> states,
    const State& scale) {
    const std::vector<State> along = whole_cycle_states(p, orbit);
    const std::size_t n = along.size(), end = phase_of(states.back(), along, scale);
    std::size_t k = states.size();
    while (k > 0 && distance(states[k - 1], along[(end + n - (states.size() - k) % n) % n], scale) <
                        captured_within)
        --k;
    return k < states.size() ? std::optional(k) : std::nullopt;
}

/// When the run came to the orbit, and its exponents before and after.
Capture capture_by(
    const Parameters& p, const State& start, std::span<const State> states, const State& scale,
    const RegimeEvidence& e, const PeriodicOrbit& orbit, bool exponents_before) {
    const auto from = captured_from(p, orbit, states, scale);
    Capture capture{
        from ? std::optional(e.stroboscopic.tau(*from)) : std::nullopt,
        {nan, nan, nan, nan},
        orbit.exponents(p),
        std::nullopt};
    if (!exponents_before) return capture;
    const double until = capture.tau.value_or(e.tau_end);
    Lyapunov before(p, 0, until, qr_alone);
    Observer* const observers[] = {&before};
    if (simulate(p, start, {until, std::numeric_limits<long>::max(), e.stop}, observers).reason !=
        End::tau_end)
        return capture;
    capture.before = before.product().qr();
    capture.chaotic_before = verdict_by_exponents(growth_of(before.product())) == Verdict::chaotic;
    return capture;
}

RegimeType type_of(const Regime& r) {
    if (!r.forced) return RegimeType::none;
    if (r.orbit) {
        if (r.orbit->contacts == 0) return RegimeType::none;
        if (r.orbit->contacts != 2L * r.orbit->cycles) return RegimeType::V;
        if (r.orbit->cycles == 1 && r.orbit->symmetric) return RegimeType::III;
        return RegimeType::IV;
    }
    if (r.contacts == 0) return RegimeType::none;
    if (r.z > 2 * (1 + irregular_margin)) return RegimeType::VI;
    return r.longest_synchronised >= shortest_stretch ? RegimeType::II : RegimeType::I;
}

}  // namespace

const char* name_of(RegimeType type) {
    constexpr const char* names[] = {"none", "I", "II", "III", "IV", "V", "VI"};
    return names[static_cast<int>(type)];
}

Regime regime_of(
    const Parameters& p, const State& start, const RegimeEvidence& e, bool exponents_before) {
    Regime r;
    r.forced = p.G > 0;
    const std::vector<CountedContact> contacts =
        within(e.contacts.contacts, e.tau_start, e.tau_end);
    count_contacts(r, contacts, p.cycle(), e);
    find_stretches(r, contacts, 0.5 * p.cycle());
    const std::span<const State> states = states_before(e.stroboscopic, e.tau_end);
    // The first in the window only says whether there are any.
    if (r.forced && states.size() > 1 && e.stroboscopic.tau(states.size() - 2) >= e.tau_start) {
        // Of the last part: a transient may have been larger.
        const State scale = scale_of(p, states.last(std::min(states.size(), longest_period)));
        r.orbit = orbit_of(p, states, scale, e);
        r.search_stopped = !r.orbit && e.stop && e.stop();
        if (r.orbit) {
            r.z = static_cast<double>(r.orbit->contacts) / r.orbit->cycles;
            r.capture = capture_by(p, start, states, scale, e, *r.orbit, exponents_before);
        }
    }
    r.type = type_of(r);
    return r;
}

namespace {

/// Why a motion that an orbit captured is not decided.
VerdictReason undecided_by(const Capture& capture) {
    return capture.chaotic_before ? VerdictReason::transient : VerdictReason::not_known_before;
}

/// Why growth is not enough for chaos.
VerdictReason undecided_by(const Growth& g) {
    const double error = verdict_sigmas * g.standard_error[0];
    if (std::isnan(error)) return VerdictReason::no_error;
    if (g.lambda1 < -error) return VerdictReason::negative;
    if (g.lambda1 <= error) return VerdictReason::within_error;
    return g.whole <= least_growth ? VerdictReason::little_growth : VerdictReason::algebraic_growth;
}

}  // namespace

Judgement judge(const Growth& g, const Regime& r, double tau_start) {
    if (!r.forced) return {Verdict::none, VerdictReason::free_decay};
    if (r.type == RegimeType::none && verdict_by_exponents(g) != Verdict::chaotic)
        return {Verdict::none, VerdictReason::untouched};
    if (r.capture && r.capture->tau && tau_start >= *r.capture->tau)
        return {Verdict::regular, VerdictReason::on_orbit};
    if (verdict_by_exponents(g) == Verdict::chaotic)
        return {Verdict::chaotic, VerdictReason::growth};
    if (r.capture && r.capture->chaotic_before == false)
        return {Verdict::regular, VerdictReason::settling};
    return {Verdict::not_decided, r.capture ? undecided_by(*r.capture) : undecided_by(g)};
}

}  // namespace vines
