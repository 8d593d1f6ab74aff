#include "core/measurement/measured_exponents.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/measurement/robust.hpp"
#include "core/measures/energy.hpp"
#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

constexpr double hiding_gap = 0.1;  // of a typical flight

// Impacts from which on a record is representative; where the jumps are alike, from fewer on
// (measured_exponents.hpp).
constexpr std::size_t enough_impacts = 200, enough_if_alike = 80;
// How alike they must be at the fewest, and by how much less for each impact more.
constexpr double alike = 0.02, alike_per_impact = 0.001;
constexpr double nine_in_ten = 0.9;

// Fewer impacts do not show whether a motion weakens; one that does loses this factor from the
// first quarter to the last.
constexpr std::size_t fewest_of_decay = 20;
constexpr double least_fall = 2;
// A forcing that alone would move the oscillator by less than this share of what it still moves is
// as good as none: a stopped shaker hums, and a fit always finds a little.
constexpr double negligible_forcing = 0.05;
// So many of a quarter may be.
constexpr std::size_t false_ones = 1;

/// What carries deviations between impacts.
struct Flows {
    Flow free, stuck;
};

/// T over the way to impact i from the one before it, which the caller knows to fit.
void append(
    const Parameters& p, const Flows& flows, const IdentifiedImpact& before,
    const IdentifiedImpact& i, TransferProduct& product) {
    Impact impact{};
    impact.R = p.restitution(i.side);
    impact.relative_speed_before = i.x_dot_before - i.y_dot_before;
    impact.x_ddot_before = i.x_ddot_before;
    const double duration = i.tau - before.tau,
                 stuck = before.release ? before.release->tau - before.tau : 0;
    const Leg legs[] = {
        leg_of(flows.stuck, stuck, true), leg_of(flows.free, duration - stuck, false)};
    product.append(
        std::span(legs).subspan(before.release ? 0 : 1), saltation(p, impact),
        product.end_tau() + duration);
}

std::vector<SlowState> slow_states(
    const Parameters& p, const std::vector<IdentifiedImpact>& impacts) {
    std::vector<double> amplitudes;
    std::vector<SlowState> states;
    for (const IdentifiedImpact& i : impacts) {
        states.push_back(slow_state(i.x, i.x_dot_after, p.Omega * i.tau));
        amplitudes.push_back(states.back().norm());
    }
    const double typical = median(std::move(amplitudes));
    for (SlowState& s : states) s /= typical;
    return states;
}

}  // namespace

Continuity continuity_of(
    const Parameters& p, const std::vector<IdentifiedImpact>& impacts,
    const std::vector<TimeGap>& gaps) {
    Continuity c;
    std::vector<double> flights, speeds;
    for (std::size_t i = 1; i < impacts.size(); ++i) {
        if (impacts[i].is_hidden || impacts[i - 1].is_hidden) continue;
        flights.push_back(impacts[i].tau - impacts[i - 1].tau);
        speeds.push_back(std::abs(impacts[i].y_dot_before));
    }
    const double typical_flight = median(flights), typical_speed = median(speeds);
    const auto over_gap = [&](double from, double to) {
        return std::any_of(gaps.begin(), gaps.end(), [&](const TimeGap& g) {
            return g.to - g.from > hiding_gap * typical_flight && g.overlaps(from, to);
        });
    };
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        if (impacts[i].is_left_out()) {
            ++c.left_out;
            continue;
        }
        const bool follows = i > 0 && !impacts[i - 1].is_left_out();
        const bool known = follows && flight_fits(p, impacts[i - 1], impacts[i], typical_speed) &&
                           !over_gap(impacts[i - 1].tau, impacts[i].tau);
        if (known && !c.stretches.empty() && c.stretches.back().last == i - 1)
            c.stretches.back().last = i;
        else if (known) c.stretches.push_back({i - 1, i});
        else if (follows) ++c.missing;
    }
    const long seen = std::count_if(
        impacts.begin(), impacts.end(), [](const IdentifiedImpact& i) { return !i.is_hidden; });
    if (seen > 0)
        c.share =
            static_cast<double>(c.left_out + c.missing) / static_cast<double>(seen + c.missing);
    return c;
}

ExponentOptions of_all_stretches(const ExponentOptions& asked) {
    return {.qr = true, .history = asked.history};
}

ExponentOptions of_longest_stretch(const ExponentOptions& asked) {
    return {
        .eigenvalues = asked.eigenvalues,
        .raw_product = asked.raw_product,
        .history = asked.history};
}

MeasuredExponents::MeasuredExponents(
    const Parameters& p, const MeasuredOscillator& oscillator,
    const std::vector<IdentifiedImpact>& impacts, const std::vector<KnownStretch>& stretches,
    const ExponentOptions& o)
    : all_(p.epsilon, of_all_stretches(o)),
      longest_(p.epsilon, of_longest_stretch(o)) {
    // Deviations know nothing of the forcing.
    const double mass = 1 + p.epsilon;
    const Flows flows{
        {oscillator.stiffness, oscillator.damping, 0, p.Omega},
        {oscillator.stiffness / mass, oscillator.damping / mass, 0, p.Omega}};
    const auto feed = [&](const KnownStretch& s, TransferProduct& product, const auto& fed) {
        if (product.impacts() == 0) product.start(impacts[s.first].tau);
        for (std::size_t i = s.first + 1; i <= s.last; ++i) {
            append(p, flows, impacts[i - 1], impacts[i], product);
            fed(i);
        }
    };
    const std::vector<SlowState> states = slow_states(p, impacts);
    const auto follow = [&](std::size_t i) {
        const SlowState before = slow_.empty() ? SlowState::Zero() : slow_.back().state;
        slow_.push_back({all_.end_tau(), before + (states[i] - states[i - 1])});
    };
    const auto length = [&](const KnownStretch& s) {
        return impacts[s.last].tau - impacts[s.first].tau;
    };
    for (const KnownStretch& s : stretches) {
        starts_.push_back(
            {starts_.empty() ? impacts[s.first].tau : all_.end_tau(), impacts[s.first].tau});
        feed(s, all_, follow);
    }
    const auto longest = std::max_element(
        stretches.begin(), stretches.end(),
        [&](const auto& a, const auto& b) { return length(a) < length(b); });
    if (longest != stretches.end()) feed(*longest, longest_, [](std::size_t) {});
}

double MeasuredExponents::moment(double clock) const {
    // The end of a stretch and the start of the next have one time of the clock: it is the end's.
    auto after = std::lower_bound(
        starts_.begin(), starts_.end(), clock,
        [](const Start& s, double c) { return s.clock < c; });
    if (after != starts_.begin()) --after;
    return after == starts_.end() ? nan : after->tau + (clock - after->clock);
}

MeasuredSlope MeasuredExponents::slope() const {
    const ExponentHistory& h = all_.qr_history();
    std::vector<SlowState> states;
    auto at = slow_.begin();
    for (const double clock : h.tau) {
        while (at != slow_.end() && at->clock < clock) ++at;
        states.push_back(at == slow_.end() ? SlowState::Zero() : at->state);
    }
    return measured_slope(h, all_.start_tau(), states);
}

bool is_representative(const std::vector<IdentifiedImpact>& impacts) {
    std::vector<double> jumps[2], off;
    std::size_t known = 0;
    for (const IdentifiedImpact& i : impacts) known += !i.is_left_out() && !i.is_hidden;
    if (known >= enough_impacts || known < enough_if_alike) return known >= enough_impacts;
    for (std::size_t k = impacts.size() / 2; k < impacts.size(); ++k)
        if (!impacts[k].is_left_out() && !impacts[k].is_hidden)
            jumps[impacts[k].side > 0].push_back(
                std::abs(impacts[k].x_dot_after - impacts[k].x_dot_before));
    for (const auto& of_side : jumps)
        for (const double jump : of_side) off.push_back(jump / median(of_side) - 1);
    return quantile_of_moduli(off, nine_in_ten) <
           alike + alike_per_impact * static_cast<double>(known - enough_if_alike);
}

bool weakens(const std::vector<IdentifiedImpact>& impacts) {
    if (impacts.size() < fewest_of_decay) return false;
    // Of a chatter only the first impact tells how strong it was; and one may be false.
    std::array<std::vector<double>, 4> jumps;
    const double start = impacts.front().tau, duration = impacts.back().tau - start;
    for (const IdentifiedImpact& i : impacts) {
        const double quarter = std::min(3.0, 4 * (i.tau - start) / duration);
        if (!i.is_left_out())
            jumps[static_cast<std::size_t>(quarter)].push_back(
                std::abs(i.x_dot_after - i.x_dot_before));
    }
    // The weaker, the longer the flights: a quarter without an impact says nothing against it.
    std::vector<double> largest;
    for (std::vector<double>& quarter : jumps) {
        std::sort(quarter.rbegin(), quarter.rend());
        if (!quarter.empty()) largest.push_back(quarter[std::min(false_ones, quarter.size() - 1)]);
    }
    return std::is_sorted(largest.rbegin(), largest.rend()) && largest.size() > 1 &&
           largest.back() > 0 && largest.back() * least_fall < largest.front();
}

bool is_unforced(const Parameters& p, const std::vector<IdentifiedImpact>& impacts) {
    if (p.G == 0) return true;
    const double quarter = 0.25 * (impacts.back().tau - impacts.front().tau);
    double last = 0;
    for (const IdentifiedImpact& i : impacts)
        if (!i.is_left_out() && i.tau >= impacts.back().tau - quarter)
            last = std::max(last, elementary::hypot(i.x, i.x_dot_after));
    return free_amplitude(p).value_or(infinity) < negligible_forcing * last;
}

IdentifiedExponents judge_exponents(
    const MeasuredOscillator& oscillator, const MeasuredExponents& exponents, bool representative) {
    IdentifiedExponents e{exponents.slope(), Verdict::not_decided};
    if (e.slope.low > oscillator.zeta()) e.verdict = Verdict::chaotic;
    if (e.slope.high < oscillator.zeta() && representative) e.verdict = Verdict::regular;
    return e;
}

}  // namespace vines
