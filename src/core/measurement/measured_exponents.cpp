#include "core/measurement/measured_exponents.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

namespace vines {

namespace {

// The slow state's effect is fitted to growth over this tau and at most this part of the record.
constexpr double difference_tau = 50, most_of_difference = 1.0 / 14;
// Prior for that effect when the slow state changes by the whole amplitude: a periodic motion
// determines none.
constexpr double largest_part = 30;
// Lag window of the spectrum (Tukey-Hanning), as a fraction of the record: steps further apart are
// taken as independent. docs/physics.md has how often the intervals contain the exponent.
constexpr double dependent = 0.06;
// Lower bound, over the variance of independent steps: the estimate can be negative.
constexpr double least_variance = 0.02;
// Half width of a 90 % interval in standard errors: Student's t with that window's 22 degrees.
constexpr double student = 1.717;
// For a record of this length the interval is twice as wide, since one or two modulations do not
// show how much later ones differ; the excess falls with the cube of the length.
constexpr double short_tau = 250;

using SlowState = Eigen::Vector2d;

/// Effect of the slow state on the sum, from differences over `apart` steps, with its `change`.
SlowState part_of_state(
    const GrowthSteps& steps, const std::vector<SlowState>& change, std::size_t apart,
    double slope) {
    Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0;
    const std::size_t differences = change.size() - apart + 1;
    for (std::size_t i = 0; i < differences; ++i) {
        Eigen::Vector3d row = Eigen::Vector3d::Zero();
        double grown = 0;
        for (std::size_t k = i; k < i + apart; ++k) {
            row(0) += steps.duration[k];
            row.tail<2>() += change[k];
            grown += steps.log[k] - slope * steps.duration[k];
        }
        N += row * row.transpose();
        right += row * grown;
        squares += grown * grown;
    }
    // Differences overlap: about one in `apart` is independent.
    const double variance = static_cast<double>(apart) * squares / static_cast<double>(differences);
    N.bottomRightCorner<2, 2>().diagonal().array() += variance / (largest_part * largest_part);
    const Eigen::Vector3d by = N.inverse() * right;
    return by.allFinite() ? SlowState(by.tail<2>()) : SlowState::Zero();
}

/// Variance of the sum of correlated steps of mean zero, after a fit of `fitted` values.
double variance_with_fit(const std::vector<double>& off, std::size_t fitted) {
    const double n = count_of(off);
    const int lags = std::max(1, static_cast<int>(dependent * n));
    const auto covariance = [&off](int lag) {
        return std::inner_product(off.begin() + lag, off.end(), off.begin(), 0.0);
    };
    const double independent = covariance(0);
    double variance = independent;
    for (int lag = 1; lag <= lags; ++lag)
        variance += (1 + elementary::cos(std::numbers::pi * lag / lags)) * covariance(lag);
    // Corrects for the fitted part and for the removed mean.
    return std::max(variance, least_variance * independent) / (1 - 0.75 * dependent) /
           (1 - static_cast<double>(fitted) / n);
}

// Tolerance of a flight: of its speed, and of the distance between the walls.
constexpr double flight_tolerance = 0.1;
constexpr double hiding_fraction = 0.1;  // fraction of a typical flight

// Impacts of a representative record, and of one whose jumps are alike.
constexpr std::size_t enough_impacts = 200, enough_if_alike = 80;
// Tolerance of the jumps at the fewest impacts, and its increase with each further impact.
constexpr double alike = 0.02, alike_per_impact = 0.001;
constexpr double nine_in_ten = 0.9;

// Fewest impacts that show a decay, and the factor lost from the first quarter to the last.
constexpr std::size_t fewest_of_decay = 20;
constexpr double least_fall = 2;
constexpr std::size_t false_ones = 1;  // tolerated false impacts in a quarter

/// The legs from the first impact of a run to the second.
class FlightLegs : public TransferObserver {
public:
    explicit FlightLegs(const Parameters& p) : TransferObserver(p, {-infinity, infinity}) {}

    std::optional<Impact> end;
    std::vector<Leg> legs;

private:
    void on_transfer(const Impact& impact, const Saltation&, std::span<const Leg> passed) override {
        if (end) return;
        end = impact;
        legs.assign(passed.begin(), passed.end());
    }
};

// Distance within which a run reaches a measured impact, in tau.
constexpr double same_impact = 0.1;

/// The legs of a run of the system from its state at `leaves` to an impact; none if it leads to
/// another one.
std::optional<std::vector<Leg>> legs_between(
    const IdentifiedSystem& system, const Release& leaves, double y, double y_dot,
    const IdentifiedImpact& to) {
    FlightLegs flight(system.own);
    Impact first{};
    first.tau = system.start_of(leaves.tau);
    flight.on_impact(first);
    system.run(
        leaves.tau, {leaves.x_dot, leaves.x, y_dot, y},
        {.tau_end = to.tau + same_impact, .max_impacts = 1}, {&flight});
    if (!flight.end || flight.end->side != to.side ||
        std::abs(system.measured_time(flight.end->tau, leaves.tau) - to.tau) > same_impact)
        return std::nullopt;
    return std::move(flight.legs);
}

/// Appends the transfer matrix from the previous impact to impact i; the flight must be known. With
/// a system it is in the units of its runs, which changes no exponent.
void append(
    const Parameters& p, const Flow& free, const Flow& stuck, const IdentifiedSystem* system,
    const IdentifiedImpact& before, const IdentifiedImpact& i, TransferProduct& product) {
    const double faster = system ? system->faster : 1;
    Impact impact{};
    impact.side = i.side;
    impact.relative_speed_before = i.x_dot_before - i.y_dot_before;
    impact.R = p.restitution(i.side, std::abs(impact.relative_speed_before));
    impact.x_ddot_before = i.x_ddot_before / (faster * faster);
    impact.y_ddot_before = p.friction * i.side / (faster * faster);
    impact.relative_speed_before /= faster;
    const double duration = i.tau - before.tau,
                 sticking = before.release ? before.release->tau - before.tau : 0;
    std::vector<Leg> legs;
    if (before.release) legs.push_back(leg_of(stuck, faster * sticking, true));
    std::optional<std::vector<Leg>> flight;
    if (system) {
        const Release leaves =
            before.release.value_or(Release{before.tau, before.x, before.x_dot_after});
        flight = legs_between(
            *system, leaves, leaves.x - before.side * p.b,
            before.release ? leaves.x_dot : before.y_dot_after, i);
    }
    if (flight) legs.insert(legs.end(), flight->begin(), flight->end());
    else legs.push_back(leg_of(free, faster * (duration - sticking), false));
    product.append(legs, saltation(system ? system->own : p, impact), product.end_tau() + duration);
}

/// Whether the mass can have flown freely from one impact to the next: with one velocity, from wall
/// to wall. If not, an impact between them is missing, or the mass stuck to the wall.
bool flight_fits(
    const Parameters& p, const IdentifiedImpact& from, const IdentifiedImpact& to,
    double typical_speed) {
    const Release leaves = from.release.value_or(Release{from.tau, from.x, from.y_dot_after});
    const double duration = to.tau - leaves.tau,
                 way = to.x - to.side * p.b - (leaves.x - from.side * p.b),
                 flown = 0.5 * (leaves.x_dot + to.y_dot_before) * duration,
                 braked = p.friction * duration;
    return std::abs(to.y_dot_before - leaves.x_dot) < flight_tolerance * typical_speed + braked &&
           std::abs(way - flown) < flight_tolerance * p.b + 0.25 * braked * duration;
}

std::vector<SlowState> slow_states(const Parameters& p, const IdentifiedImpacts& impacts) {
    std::vector<SlowState> states;
    for (const IdentifiedImpact& i : impacts) {
        const double sin = elementary::sin(p.Omega * i.tau), cos = elementary::cos(p.Omega * i.tau);
        states.emplace_back(i.x * cos - i.x_dot_after * sin, i.x * sin + i.x_dot_after * cos);
    }
    const double typical = median(values_of(states, [](const SlowState& s) { return s.norm(); }));
    for (SlowState& s : states) s /= typical;
    return states;
}

/// Whether a slope below zeta characterises the motion, and not a synchronised stretch of a chaotic
/// one. In windows of 100 impacts of Table 4's system at b = 11 mm 142 of 506 look regular, of 150
/// impacts 2 of 335, of 170 or more none. In windows of 80 impacts, however, the jumps of the
/// second half never agree within 2 %, in windows of 150 never within 9 %, while those of a
/// periodic motion soon do (nine in ten jumps, relative to the typical jump at their wall). From
/// six b between 10.8 and 13 mm, about 30,000 windows of 80 to 200 impacts.
bool is_representative(const IdentifiedImpacts& impacts) {
    const std::size_t known =
        std::ranges::count_if(impacts, &IdentifiedImpact::is_good_and_visible);
    if (known >= enough_impacts || known < enough_if_alike) return known >= enough_impacts;
    std::vector<double> jumps[2], off;
    for (std::size_t k = impacts.size() / 2; k < impacts.size(); ++k)
        if (impacts[k].is_good_and_visible())
            jumps[impacts[k].side > 0].push_back(std::abs(impacts[k].jump()));
    for (const auto& of_side : jumps)
        for (const double jump : of_side) off.push_back(jump / median(of_side) - 1);
    return quantile_of_moduli(off, nine_in_ten) <
           alike + alike_per_impact * static_cast<double>(known - enough_if_alike);
}

}  // namespace

Continuity continuity_of(
    const Parameters& p, const IdentifiedImpacts& impacts, std::vector<Interval> gaps) {
    Continuity c;
    std::vector<double> flights, speeds;
    for (std::size_t i = 1; i < impacts.size(); ++i) {
        if (impacts[i].is_hidden || impacts[i - 1].is_hidden) continue;
        flights.push_back(impacts[i].tau - impacts[i - 1].tau);
        speeds.push_back(std::abs(impacts[i].y_dot_before));
    }
    const double typical_flight = median(flights), typical_speed = median(speeds);
    std::erase_if(gaps, [&](const Interval& g) {
        return !(g.to - g.from > hiding_fraction * typical_flight);
    });
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        if (impacts[i].is_left_out()) {
            ++c.left_out;
            continue;
        }
        const bool follows = i > 0 && !impacts[i - 1].is_left_out();
        const bool known = follows && flight_fits(p, impacts[i - 1], impacts[i], typical_speed) &&
                           !overlaps_any(gaps, impacts[i - 1].tau, impacts[i].tau);
        if (known && !c.stretches.empty() && c.stretches.back().last == i - 1)
            c.stretches.back().last = i;
        else if (known) c.stretches.push_back({i - 1, i});
        else if (follows) ++c.missing;
    }
    const auto seen = std::ranges::count(impacts, false, &IdentifiedImpact::is_hidden);
    const auto lost = static_cast<double>(c.left_out + c.missing);
    if (seen > 0) c.share = lost / static_cast<double>(seen + c.missing);
    return c;
}

MeasuredExponents::MeasuredExponents(
    const Parameters& p, const UnknownValues& v, const IdentifiedImpacts& impacts,
    const std::vector<KnownStretch>& stretches, const ExponentOptions& o,
    const IdentifiedSystem* system)
    : zeta_(0.5 * v[Unknown::damping]),
      all_(p.epsilon, {.qr = true, .history = o.history}),
      longest_(
          p.epsilon,
          {.eigenvalues = o.eigenvalues, .raw_product = o.raw_product, .history = o.history}) {
    // The growth of deviations does not depend on the forcing.
    const double faster = system ? system->faster : 1,
                 k = v[Unknown::stiffness] / (faster * faster), c = v[Unknown::damping] / faster,
                 mass = 1 + p.epsilon;
    const Flow free(k, c, 0, p.Omega / faster), stuck(k / mass, c / mass, 0, p.Omega / faster);
    const std::vector<SlowState> states = slow_states(p, impacts);
    SlowState slow = SlowState::Zero();
    for (const KnownStretch& s : stretches) {
        const double tau = impacts[s.first].tau;
        if (starts_.empty()) all_.start(tau);
        starts_.push_back({starts_.empty() ? tau : all_.end_tau(), tau});
        for (std::size_t i = s.first + 1; i <= s.last; ++i) {
            append(p, free, stuck, system, impacts[i - 1], impacts[i], all_);
            slow += states[i] - states[i - 1];
            slow_.push_back({all_.end_tau(), slow});
        }
    }
    const auto longest = std::ranges::max_element(stretches, {}, [&](const KnownStretch& s) {
        return impacts[s.last].tau - impacts[s.first].tau;
    });
    if (longest == stretches.end()) return;
    longest_.start(impacts[longest->first].tau);
    for (std::size_t i = longest->first + 1; i <= longest->last; ++i)
        append(p, free, stuck, system, impacts[i - 1], impacts[i], longest_);
}

double MeasuredExponents::moment(double clock) const {
    // Between two stretches the clock shows one time: the end's is returned.
    auto after = std::ranges::lower_bound(starts_, clock, {}, &StretchStart::clock);
    if (after != starts_.begin()) --after;
    return after == starts_.end() ? nan : after->tau + (clock - after->clock);
}

MeasuredSlope MeasuredExponents::slope() const {
    const ExponentHistory& h = all_.qr_history();
    const std::size_t stride = h.coarse_stride(), entries = (h.tau.size() + stride - 1) / stride;
    GrowthSteps steps = growth_steps(h, all_.start_tau(), stride);
    const double plain = slope_of(steps);
    if (std::isnan(plain)) return {nan, nan, nan};
    const auto state_at = [&](std::size_t entry) -> SlowState {
        const auto at = std::ranges::lower_bound(slow_, h.tau[entry], {}, &SlowAt::clock);
        return at == slow_.end() ? SlowState::Zero() : at->state;
    };
    std::vector<SlowState> change;
    for (std::size_t k = entries - steps.log.size(); k < entries; ++k)
        change.push_back(state_at(k * stride) - state_at((k - 1) * stride));
    const double duration = std::accumulate(steps.duration.begin(), steps.duration.end(), 0.0),
                 fraction = std::min(most_of_difference, difference_tau / duration);
    const auto apart = static_cast<std::size_t>(std::max(1.0, count_of(change) * fraction));
    const SlowState by = part_of_state(steps, change, apart, plain);
    for (std::size_t i = 0; i < change.size(); ++i) steps.log[i] -= by.dot(change[i]);
    const double slope = slope_of(steps);
    std::vector<double> off;
    for (std::size_t i = 0; i < change.size(); ++i)
        off.push_back(steps.log[i] - slope * steps.duration[i]);
    const double brief = short_tau / duration, error = std::sqrt(variance_with_fit(off, apart)),
                 half = (1 + brief * brief * brief) * student * error / duration;
    return {slope, slope - half, slope + half};
}

bool weakens(const IdentifiedImpacts& impacts) {
    if (impacts.size() < fewest_of_decay) return false;
    // A chatter is represented by its first impact; one impact can be false.
    std::array<std::vector<double>, 4> jumps;
    const double start = impacts.front().tau, duration = impacts.back().tau - start;
    for (const IdentifiedImpact& i : impacts) {
        const double quarter = std::min(3.0, 4 * (i.tau - start) / duration);
        if (!i.is_left_out())
            jumps[static_cast<std::size_t>(quarter)].push_back(std::abs(i.jump()));
    }
    // Weak motions have long flights, so a quarter without impacts does not contradict a decay.
    std::vector<double> largest;
    for (std::vector<double>& quarter : jumps) {
        std::sort(quarter.rbegin(), quarter.rend());
        if (!quarter.empty()) largest.push_back(quarter[std::min(false_ones, quarter.size() - 1)]);
    }
    return std::is_sorted(largest.rbegin(), largest.rend()) && largest.size() > 1 &&
           largest.back() > 0 && largest.back() * least_fall < largest.front();
}

IdentifiedExponents judge_exponents(
    const MeasuredExponents& exponents, const IdentifiedImpacts& impacts) {
    IdentifiedExponents e{exponents.slope(), Verdict::not_decided};
    if (e.slope.low > exponents.zeta()) e.verdict = Verdict::chaotic;
    if (e.slope.high < exponents.zeta() && is_representative(impacts)) e.verdict = Verdict::regular;
    return e;
}

}  // namespace vines
