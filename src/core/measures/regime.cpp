#include "core/measures/regime.hpp"

#include <algorithm>
#include <cmath>

#include "core/measures/energy.hpp"

namespace vines {

namespace {

// Distance, in units of the scale, below which two states can be a return. A chaotic run comes
// within `near_return` by chance all the time.
constexpr double near_return = 0.1, near_return_if_chaotic = 1e-3;
// Limits of the attempts: number, and sum of the periods after the first.
constexpr int most_attempts = 8;
constexpr std::size_t most_attempted_cycles = 1024;
constexpr double irregular_margin = 0.02;  // z of an irregular response is a mean over a run
// Continuations, in cycles, of a run that is near a return but not on an orbit.
constexpr int follow_rounds[] = {150, 300, 600, 1200};
// Whole cycles are run slightly longer, so that rounding does not cut off the last one.
constexpr double past_last_cycle = 1e-12;
// A run counts as captured while it stays this close to the orbit.
constexpr double captured_within = 0.1;
// Chaos that is confined to the orbit's neighbourhood is searched up to this distance.
constexpr double settled_within = 1e-3;
// Cycles for which a run that ends near the orbit is followed, and those between two looks.
constexpr int longest_departure = 4096, cycles_of_look = 64;
// Growth on the way, as a logarithm, by which rounding reaches 1e-5 of the motion.
constexpr double most_growth_of_rounding = 25;
constexpr std::size_t transient_history = 4096;  // entries searched for a chaotic transient
// A chaotic run is continued in rounds of this many cycles.
constexpr long cycles_of_round = 1024;
constexpr long most_impacts_per_cycle = 1000;  // exceeded by endless chatter (R = 1) alone
// Longest time, in cycles, in which the next contact of a flying ball is searched.
constexpr double longest_flight = 10000;

/// A possible period: the power of ten of its miss, and its cycles.
using Return = std::pair<int, std::size_t>;

/// Possible periods: the closest returns first, among about equally close ones the shortest.
std::vector<Return> returns(std::span<const State> states, const State& scale, double near) {
    constexpr double rounding = 1e-10;  // closer returns all count as equally close
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
        found.emplace_back(decade, cycles);
    }
    std::ranges::sort(found);
    return found;
}

/// Attracting periodic orbit near the last state. `tried` is set if a return came close.
std::optional<PeriodicOrbit> orbit_at_end(
    const Parameters& p, std::span<const State> states, const State& scale, double near,
    const StopRequest& stop, bool& tried) {
    int attempts = 0;
    std::size_t attempted = 0;
    for (const auto& [decade, cycles] : returns(states, scale, near)) {
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

/// Index of the orbit's state at a whole cycle that is closest to s.
std::size_t phase_of(const State& s, std::span<const State> along, const State& scale) {
    const auto miss = [&](const State& on_orbit) { return distance(s, on_orbit, scale); };
    return static_cast<std::size_t>(std::ranges::min_element(along, {}, miss) - along.begin());
}

/// Attracting periodic orbit at the end of a run. A run can end while it slowly leaves an unstable
/// orbit for a stable one that Newton's method does not reach from there: then it is continued.
std::optional<PeriodicOrbit> orbit_of(
    const Parameters& p, std::span<const State> states, const State& scale,
    const RegimeEvidence& e) {
    const bool chaotic = e.by_exponents == Verdict::chaotic;
    bool tried = false;
    if (auto orbit = orbit_at_end(
            p, states, scale, chaotic ? near_return_if_chaotic : near_return, e.stop, tried))
        return orbit;
    if (chaotic) return std::nullopt;
    State s = states.back();
    for (const int cycles : follow_rounds) {
        if (!tried) return std::nullopt;
        StroboscopicRecord on(p);
        if (!follow(p, s, 0, cycles * p.cycle() * (1 + past_last_cycle), e.stop, {&on}))
            return std::nullopt;
        s = on.states.back();
        tried = false;
        auto orbit = orbit_at_end(p, on.states, scale, near_return, e.stop, tried);
        if (!orbit) continue;
        const auto along = whole_cycle_states(p, *orbit);
        const State& nearest = along[phase_of(states.back(), along, scale)];
        return distance(states.back(), nearest, scale) < 2 * captured_within ? orbit : std::nullopt;
    }
    return std::nullopt;
}

/// Comparison of a run, whose state at cycle k0 is `state`, with an orbit's states at whole cycles.
struct OrbitComparison {
    std::vector<State> along;
    const State& scale;
    long k0;
    const State& state;
    long period = static_cast<long>(along.size());
    long phase = static_cast<long>(phase_of(state, along, scale)) - k0 % period + period;

    /// Distance of the state at cycle k from the orbit's state at the same phase.
    double distance_at(long k, const State& at) const {
        return distance(at, along[static_cast<std::size_t>((phase + k) % period)], scale);
    }
    bool is_near(long k, const State& at, double within = captured_within) const {
        return distance_at(k, at) < within;
    }
};

/// Finds the last of the first `before` whole cycles of a run that is not near the orbit.
class OrbitArrival : public Stroboscope {
public:
    OrbitArrival(const Parameters& p, const OrbitComparison& comparison, long before)
        : Stroboscope(p),
          comparison_(comparison),
          before_(before) {}
    long cycle = -1;
    bool arrived = false;

private:
    void take(long k, const State& state) override {
        if (k >= before_ || arrived) return;
        const double apart = comparison_.distance_at(k, state);
        if (!(apart < captured_within)) cycle = k;
        arrived = apart < on_the_orbit;
    }
    const OrbitComparison& comparison_;
    const long before_;
};

/// How a motion that ends near an orbit arrives on it.
enum class Approach {
    direct,
    later,     ///< it leaves the neighbourhood once more, as it can with a long period
    not_known  ///< rounding grows too much on the way: another orbit may attract the motion
};
/// Approach of a motion that is compared with the orbit at cycle k.
Approach approach_of(
    const Parameters& p, const State& state, long k, const OrbitComparison& comparison,
    const StopRequest& stop) {
    State s = state;
    Approach approach = Approach::direct;
    const double look = cycles_of_look * p.cycle();
    double growth = 0, least = 0;
    for (int done = 0; done < longest_departure; done += cycles_of_look) {
        StroboscopicRecord on(p);
        Lyapunov lyapunov(p, {0, look}, {.qr = true});
        if (!follow(p, s, 0, look * (1 + past_last_cycle), stop, {&on, &lyapunov})) return approach;
        const TransferProduct& product = lyapunov.product();
        if (product.impacts() > 1)
            growth += product.qr()[0] * (product.end_tau() - product.start_tau());
        least = std::min(least, growth);
        if (growth - least > most_growth_of_rounding) return Approach::not_known;
        for (const State& next : std::span(on.states).subspan(1)) {
            ++k;
            if (!comparison.is_near(k, next)) approach = Approach::later;
            if (comparison.is_near(k, next, on_the_orbit)) return approach;
        }
        s = on.states.back();
    }
    return approach;
}

/// First whole cycles from which on the run stays near the orbit, and follows it; empty if never.
struct Arrival {
    std::optional<double> captured, settled;
};
/// Empty if rounding decides whether the motion arrives on this orbit.
std::optional<Arrival> arrival_at(
    const Parameters& p, const State& start, const PeriodicOrbit& orbit,
    std::span<const State> states, const State& scale, const RegimeEvidence& e) {
    const long first = e.stroboscopic.first(), end = first + static_cast<long>(states.size());
    const OrbitComparison comparison{whole_cycle_states(p, orbit), scale, end - 1, states.back()};
    long from = end;
    const auto extend = [&](double within) {
        while (from > first && comparison.is_near(from - 1, states[from - 1 - first], within))
            --from;
        return from < end ? std::optional(e.stroboscopic.tau_of(from)) : std::nullopt;
    };
    Arrival arrival;
    arrival.settled = extend(settled_within);
    arrival.captured = extend(captured_within);
    if (!comparison.is_near(end - 1, states.back(), on_the_orbit)) {
        const Approach approach = approach_of(p, states.back(), end - 1, comparison, e.stop);
        if (approach == Approach::not_known) return std::nullopt;
        if (approach == Approach::later || from == end) return Arrival{};
    }
    // A second run examines the earlier states. If it is interrupted, the first kept state stands.
    if (from == first && first > 0) {
        OrbitArrival last(p, comparison, first);
        const Limits limits{
            .tau_end = e.stroboscopic.tau_of(first),
            .max_impacts = std::numeric_limits<long>::max(),
            .stop = [&] { return last.arrived || (e.stop && e.stop()); }};
        const End end_of_run = simulate(p, start, limits, {&last}).reason;
        if (last.arrived || end_of_run == End::tau_end)
            arrival.captured = e.stroboscopic.tau_of(last.cycle + 1);
    }
    return arrival;
}

/// Product of the transfer matrices from the start to `until`; empty if time ran out.
std::optional<TransferProduct> product_until(
    const Parameters& p, const State& start, double until, const RegimeEvidence& e) {
    Lyapunov lyapunov(p, {0, until}, {.qr = true, .history = transient_history});
    if (simulate(p, start, {until, std::numeric_limits<long>::max(), e.stop}, {&lyapunov}).reason !=
        End::tau_end)
        return std::nullopt;
    return lyapunov.take();
}

/// Adds the exponents before the capture, by a second run. Chaos near the orbit delays the capture.
void examine_before(
    const Parameters& p, const State& start, const RegimeEvidence& e, double settled,
    Capture& capture) {
    std::optional<double> chaos_until;
    if (capture.tau && settled > *capture.tau) {
        const auto product = product_until(p, start, settled, e);
        if (!product) return;
        chaos_until = chaotic_transient_end(product->qr_history(), product->start_tau());
        if (chaos_until && *chaos_until > *capture.tau)
            capture.tau = std::ceil(*chaos_until / p.cycle()) * p.cycle();
    }
    const auto product =
        product_until(p, start, std::min(capture.tau.value_or(e.tau_end), e.tau_end), e);
    if (!product) return;
    capture.before = product->qr();
    capture.chaotic_before = chaos_until ||
                             verdict_by_exponents(growth_of(*product)) == Verdict::chaotic ||
                             chaotic_transient_end(product->qr_history(), product->start_tau());
}

/// Continues a chaotic run until a periodic orbit captures it or settle_cycles have passed.
void settle_later(
    const Parameters& p, std::span<const State> states, const State& scale, const RegimeEvidence& e,
    Regime& r) {
    State s = states.back();
    const long end = e.stroboscopic.first() + static_cast<long>(states.size()) - 1;
    const long cycles = std::lround(e.settle_cycles);
    for (long done = 0, round; done < cycles; done += round) {
        round = std::min(cycles_of_round, cycles - done);
        StroboscopicRecord on(p);
        const Limits limits{
            .tau_end = static_cast<double>(round) * p.cycle() * (1 + past_last_cycle),
            .max_impacts = round * most_impacts_per_cycle,
            .stop = e.stop};
        if (simulate(p, s, limits, {&on}).reason != End::tau_end) return;
        s = on.states.back();
        bool tried = false;
        r.orbit = orbit_at_end(p, on.states, scale, near_return_if_chaotic, e.stop, tried);
        if (!r.orbit) {
            r.followed += round;
            continue;
        }
        const OrbitComparison comparison{whole_cycle_states(p, *r.orbit), scale, round, s};
        long from = round;
        while (from > 0 && comparison.is_near(from - 1, on.states[from - 1])) --from;
        r.capture = Capture{e.stroboscopic.tau_of(end + done + from), r.orbit->exponents(p)};
        return;
    }
}

/// True if friction holds a ball with the oscillator's velocity for ever: |x'' - gravity| of the
/// joint motion stays below `friction`. The energy of the joint motion's deviation u from its
/// steady one, (u'^2 + stiffness u^2)/2, falls, and |u''| <= stiffness |u| + damping |u'|.
bool held_for_ever(const Parameters& p, const State& at_whole_cycle) {
    const auto [k, d, f, Omega] = Flow::shared_sticking(p)->coefficients();
    const double detuning = k - Omega * Omega, D = elementary::hypot(detuning, d * Omega);
    if (D == 0) return false;
    const double X = f / D, theta = p.phi() - elementary::atan2(d * Omega, detuning),
                 u = at_whole_cycle.x - p.epsilon * p.gravity - X * elementary::sin(theta),
                 u_dot = at_whole_cycle.x_dot - X * Omega * elementary::cos(theta),
                 deviation = elementary::hypot(u_dot, std::sqrt(k) * u);
    return X * Omega * Omega + (std::sqrt(k) + d) * deviation + std::abs(p.gravity) < p.friction;
}

/// End of a run without contacts.
Regime::Untouched untouched_end(
    const Parameters& p, const State& at_whole_cycle, double tau, const StopRequest& stop) {
    const bool held = p.friction > 0 && at_whole_cycle.y_dot == at_whole_cycle.x_dot;
    Regime::Untouched end{
        is_never_touched(p, at_whole_cycle) || (held && held_for_ever(p, at_whole_cycle)),
        at_whole_cycle.y_dot, held, std::nullopt};
    if (end.for_ever) return end;
    const Limits limits{.tau_end = longest_flight * p.cycle(), .max_impacts = 1, .stop = stop};
    const Outcome outcome = simulate(p, at_whole_cycle, limits);
    if (outcome.impacts > 0) end.next_contact = tau + outcome.tau;
    return end;
}

RegimeType type_of(const Regime& r) {
    if (!r.forced || !r.has_period) return RegimeType::none;
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

VerdictReason undecided_by(const Capture& capture) {
    return capture.chaotic_before ? VerdictReason::transient : VerdictReason::not_known_before;
}

VerdictReason undecided_by(const Growth& g) {
    const double error = student_three_sigma * g.standard_error[0];
    if (std::isnan(error)) return VerdictReason::no_error;
    if (g.lambda1 < -error) return VerdictReason::negative;
    if (g.lambda1 <= error) return VerdictReason::within_error;
    return g.whole <= least_growth ? VerdictReason::little_growth : VerdictReason::algebraic_growth;
}

}  // namespace

// The energy x^2 + x'^2 of the deviation from the steady motion cannot grow.
bool is_never_touched(const Parameters& p, const State& s) {
    const auto steady = free_steady_state(p);
    if (!steady || !p.has_straight_flights() || s.y_dot != 0) return false;
    const double deviation = elementary::hypot(s.x - steady->x, s.x_dot - steady->x_dot);
    return *free_amplitude(p) + deviation + std::abs(s.y) < p.b;
}

const char* name_of(RegimeType type) {
    constexpr const char* names[] = {"none", "I", "II", "III", "IV", "V", "VI"};
    return names[static_cast<int>(type)];
}

Regime regime_of(
    const Parameters& p, const State& start, const RegimeEvidence& e, bool exponents_before) {
    Regime r;
    r.forced = p.is_forced();
    r.has_period = !p.load;
    static_cast<ContactCounts&>(r) = e.rhythm.finish({e.tau_start, e.tau_end});
    r.z = r.z_overall;
    if (const auto alone = std::ranges::find(r.cycles_with, 1.0); alone != r.cycles_with.end())
        r.in_every_cycle = static_cast<int>(alone - r.cycles_with.begin());
    const auto [first, end] = e.stroboscopic.range({e.tau_start, e.tau_end});
    const std::span<const State> states = std::span(e.stroboscopic.states).first(end);
    // The first state in the window only shows that the window has any.
    if (r.forced && r.has_period && states.size() > 1 &&
        e.stroboscopic.tau(states.size() - 2) >= e.tau_start) {
        // Scale of the last part: a transient can have been larger.
        const State scale = scale_of(p, states.last(std::min(states.size(), longest_period)));
        r.orbit = orbit_of(p, states, scale, e);
        r.search_stopped = !r.orbit && e.stop && e.stop();
        const auto arrival =
            r.orbit ? arrival_at(p, start, *r.orbit, states, scale, e) : std::nullopt;
        if (arrival) r.capture = Capture{arrival->captured, r.orbit->exponents(p)};
        else r.orbit.reset();
        if (!r.orbit && e.by_exponents == Verdict::chaotic) settle_later(p, states, scale, e, r);
        else if (!r.orbit && e.neutral)
            r.quasi_periodic = quasi_periodic(states.subspan(first), scale);
        if (r.orbit) r.z = static_cast<double>(r.orbit->contacts) / r.orbit->cycles;
        const double settled = arrival ? arrival->settled.value_or(e.tau_end) : e.tau_end;
        if (r.capture && exponents_before) examine_before(p, start, e, settled, *r.capture);
        if (r.contacts == 0 && !r.orbit)
            r.untouched =
                untouched_end(p, states.back(), e.stroboscopic.tau(states.size() - 1), e.stop);
    }
    r.type = type_of(r);
    return r;
}

Judgement judge(const Growth& g, const Regime& r, double tau_start) {
    if (!r.forced) return {Verdict::none, VerdictReason::free_decay};
    if (r.type == RegimeType::none && r.has_period && verdict_by_exponents(g) != Verdict::chaotic) {
        const bool for_ever = r.orbit || (r.untouched && r.untouched->for_ever);
        return for_ever ? Judgement{Verdict::none, VerdictReason::untouched}
                        : Judgement{Verdict::not_decided, VerdictReason::next_contact};
    }
    if (r.capture && r.capture->tau && tau_start >= *r.capture->tau)
        return {Verdict::regular, VerdictReason::on_orbit};
    if (verdict_by_exponents(g) == Verdict::chaotic)
        return {Verdict::chaotic, VerdictReason::growth};
    if (r.quasi_periodic) return {Verdict::regular, VerdictReason::quasi_periodic};
    if (r.capture && r.capture->chaotic_before == false)
        return {Verdict::regular, VerdictReason::settling};
    return {Verdict::not_decided, r.capture ? undecided_by(*r.capture) : undecided_by(g)};
}

}  // namespace vines
