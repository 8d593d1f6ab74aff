// The equations of a Gauss-Newton step of the joint fit (unknowns.hpp): samples of both sensors,
// conditions at the borders between intervals, flights of the mass, priors, and a given forcing.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/measurement/joint_equations.hpp"
#include "core/measurement/robust.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Jump of x allowed at an impact, over a sample's noise. Smaller values cost digits.
constexpr double continuity_share = 0.05;
// Huber weights: residuals beyond these numbers of deviations count less, and not at all.
constexpr double huber_sigmas = 2.5, ignored_sigmas = 8;
// Standard error of a release time from its condition, in tau: below all others.
constexpr double release_error = 1e-4;
// Relative tolerance of a given forcing: far more precise than any record.
constexpr double known_to = 1e-7;
// Scatter of eqs. (36) and (4) at real impacts, at least, over typical jump and approach speed.
constexpr double least_momentum = 2e-4, least_restitution = 5e-4;

/// Whether an unknown keeps its value: fixed, or nonlinear in the motion in the first step.
bool is_held(const JointFitState& state, std::size_t unknown) {
    return state.fit.fixed[unknown] ||
           (state.is_first_step && unknown >= static_cast<std::size_t>(Unknown::x_gain));
}

/// Zeroes the derivatives by unknowns that keep their values.
void clear_held(const JointFitState& state, MotionDerivatives& by) {
    for (std::size_t k = 0; k < sensed_unknowns; ++k)
        if (is_held(state, k)) by.by_unknowns(k) = 0;
}

MotionDerivatives derivatives_of(
    const JointFitState& state, const MotionRow& row, double OscillatorMotion::* member) {
    MotionDerivatives by(row, member);
    clear_held(state, by);
    return by;
}

/// Whether the displacement at `tau` is spoiled by the kink of an impact.
bool is_at_kink(const JointFitState& state, std::size_t interval, double tau) {
    const auto& i = state.fit.intervals;
    return (interval > 0 && tau - i[interval].tau < state.spoiled.x) ||
           (interval + 1 < i.size() && i[interval + 1].tau - tau < state.spoiled.x);
}

/// Adds the samples of the displacement, or of the acceleration, and sets their residuals.
void add_samples(JointFitState& state, const IntervalFlows& flows, bool of_x) {
    const UnknownValues& v = state.fit.values;
    const FittedSensor& sensor = of_x ? state.x : state.a;
    std::vector<double>& residual = (of_x ? state.fit.x : state.fit.a).left;
    const auto member = of_x ? &OscillatorMotion::x : &OscillatorMotion::x_ddot;
    const Unknown offset = of_x ? Unknown::x_offset : Unknown::a_offset,
                  drift = of_x ? Unknown::x_drift : Unknown::a_drift;
    const double gain = of_x ? v[Unknown::x_gain] : 1, late = of_x ? v[Unknown::x_delay] : 0;
    const auto add = [&](std::size_t k, std::size_t i, const MotionRow& row) {
        state.progress.tick();
        const double tau = state.record.tau[k], u = (tau - state.fit.tau_middle) / state.fit.length,
                     shown = gain * (row.value.*member),
                     left = sensor.samples[k] - shown - v[offset] - v[drift] * u;
        residual[k] = left;
        if (sensor.ignored[k] || (of_x && is_at_kink(state, i, tau - late))) return;
        MotionDerivatives by(row, member);
        by.by_start *= gain;
        by.by_unknowns *= gain;
        element(by.by_unknowns, offset) = 1;
        element(by.by_unknowns, drift) = u;
        if (of_x) {
            element(by.by_unknowns, Unknown::x_gain) = row.value.x;
            element(by.by_unknowns, Unknown::x_delay) = -gain * row.value.x_dot;
        }
        clear_held(state, by);
        state.equations.add(
            i, by, left, state.weight(left, sensor.statistics.noise, sensor.scale),
            state.effects ? &state.effects->sample(of_x, i, tau, row) : nullptr);
    };
    each_motion(state.fit, flows, state.record.tau, late, !of_x, add);
}

/// An impact between two intervals: the motion before it is the end of the first one.
struct FittedBorder : FittedImpact {
    bool flies;                              ///< an impact without a sticking phase after it
    MotionDerivatives before;                ///< of x_dot_before
    Eigen::VectorXd before_by_effects = {};  ///< with JointFitState::effects
};

/// Border k, at the end `row` of its first interval.
FittedBorder fitted_border(const JointFitState& state, std::size_t k, const MotionRow& row) {
    const Candidate& border = state.borders[k];
    FittedBorder m{
        state.motion_at_border(k, row), border.is_impact() && !border.sticks,
        derivatives_of(state, row, &OscillatorMotion::x_dot)};
    if (state.effects)
        m.before_by_effects = state.effects->motion(k, m.tau, row, &OscillatorMotion::x_dot);
    return m;
}

/// Adds a condition on x, x' or x'' at the end of interval k; `by_moment`: its derivative by
/// the border's time; `meets`: it equals the value at the start of the next interval.
void add_border_condition(
    JointFitState& state, std::size_t k, const MotionRow& row, double OscillatorMotion::* member,
    double by_moment, bool meets, double left, double weight) {
    JointEquations& e = state.equations;
    const MotionDerivatives by = derivatives_of(state, row, member);
    JointEquations::Row terms = {
        {e.start_of(k), by.by_start(0)},
        {e.start_of(k) + 1, by.by_start(1)},
        {e.time_of(k), by_moment}};
    const Eigen::Index which = member == &OscillatorMotion::x_dot ? 1 : 0;
    if (meets) terms.push_back({e.start_of(k + 1) + which, -1});
    e.append(by.by_unknowns, 1, terms);
    const double tau = state.fit.intervals[k + 1].tau;
    e.add(
        terms, left, weight, state.effects ? &state.effects->motion(k, tau, row, member) : nullptr);
}

double jerk_at(
    const JointFitState& state, const FittedInterval& i, const OscillatorMotion& m, double tau) {
    const UnknownValues& v = state.fit.values;
    const double angle = v[Unknown::Omega] * (tau - state.fit.tau_middle);
    return (-v[Unknown::stiffness] * m.x_dot - v[Unknown::damping] * m.x_ddot +
            v[Unknown::Omega] * (v[Unknown::force_sin] * elementary::cos(angle) -
                                 v[Unknown::force_cos] * elementary::sin(angle))) /
           state.moving_mass(i);
}

/// The flight of the mass between impacts p and p + 1.
struct MassFlight {
    MassFlight(const JointFitState& state, const std::vector<FittedBorder>& impacts, std::size_t p)
        : first(p) {
        const FittedBorder &from = impacts[p], &to = impacts[p + 1];
        duration = to.tau - from.tau, walls = to.side - from.side;
        y_dot = (to.x - from.x - state.fit.values[Unknown::b] * walls) / duration;
        // Moving an impact's time also changes x there.
        by_first = (y_dot - from.x_dot_after) / duration;
        by_last = (to.x_dot_after - y_dot) / duration;
    }
    /// Appends the derivatives of y', multiplied by `times`.
    void add_to(JointEquations::Row& row, const JointFitState& state, double times) const {
        const JointEquations& e = state.equations;
        row.push_back({e.start_of(first + 1), -times / duration});
        row.push_back({e.start_of(first + 2), times / duration});
        row.push_back({e.time_of(first), times * by_first});
        row.push_back({e.time_of(first + 1), times * by_last});
        if (walls != 0 && !state.fit.fixed[Unknown::b])
            row.push_back({e.unknown_at(Unknown::b), -times * walls / duration});
    }

    std::size_t first;
    double duration, walls, y_dot, by_first, by_last;
};

/// Residuals of momentum and restitution at an impact, in m per unit of tau.
struct MassResidual {
    std::size_t impact;
    MassFlight first, second;  ///< before and after it
    double momentum, restitution;
    double jump, approach;   ///< jump of x', and x' - y' before the impact
    double R, R_derivative;  ///< R w, over w and by w = |approach|
};

/// Residuals of the impacts whose flights on both sides are known.
std::vector<MassResidual> mass_residuals(
    const JointFitState& state, const std::vector<FittedBorder>& impacts) {
    std::vector<MassResidual> residuals;
    const Parameters& p = state.parameters;
    for (std::size_t i = 1; i + 1 < impacts.size(); ++i) {
        const FittedBorder& m = impacts[i];
        if (!m.flies || impacts[i - 1].side == 0 || impacts[i + 1].side == 0) continue;
        const MassFlight first(state, impacts, i - 1), second(state, impacts, i);
        const double before = first.y_dot + m.braked_before, after = second.y_dot + m.braked_after,
                     approach = m.x_dot_before - before, w = std::abs(approach),
                     fitted = state.fit.values[restitution_at(m.side)] +
                              state.R_slope.slope * (w - state.R_slope.speed);
        const bool is_given = p.table_of(m.side) != nullptr;
        const double R = is_given ? p.restitution(m.side, w) : fitted,
                     derivative = is_given ? p.restitution_derivative(m.side, w)
                                           : fitted + state.R_slope.slope * w;
        residuals.push_back(
            {i, first, second, m.jump() + state.fit.epsilon * (after - before),
             m.x_dot_after - after + R * approach, m.jump(), approach, R, derivative});
    }
    return residuals;
}

/// Adds the equations of one impact. Weights are inverse variances.
void add_mass_rows(
    JointFitState& state, const FittedBorder& m, const MassResidual& r, double momentum_weight,
    double restitution_weight) {
    JointEquations& e = state.equations;
    EffectDerivatives* const effects = state.effects;
    const std::size_t i = r.impact;
    const Unknown wall = restitution_at(m.side);
    const double R = r.R_derivative, epsilon = state.fit.epsilon;
    Eigen::VectorXd by_effects;
    const auto add = [&](double by_after, double by_before, double by_first, double by_second,
                         double by_R, double residual, double weight) {
        if (effects) {
            by_effects = by_before * m.before_by_effects;
            by_effects(effects->first_of(Effect::friction)) +=
                by_first * effects->flight(i - 1, -1) + by_second * effects->flight(i, 1);
            by_effects(effects->first_of(Effect::R_varies)) +=
                by_R * (std::abs(r.approach) - effects->mean_speed);
            if (const Eigen::Index at = effects->first_of(Effect::given_mass_ratio); at >= 0)
                by_effects(at) += by_second == epsilon ? (r.momentum - r.jump) / epsilon : 0;
        }
        JointEquations::Row row = {
            {e.start_of(i + 1) + 1, by_after},
            {e.start_of(i), by_before * m.before.by_start(0)},
            {e.start_of(i) + 1, by_before * m.before.by_start(1)},
            {e.time_of(i), by_after * m.x_ddot_after + by_before * m.x_ddot_before}};
        e.append(m.before.by_unknowns, by_before, row);
        r.first.add_to(row, state, by_first);
        r.second.add_to(row, state, by_second);
        if (by_R != 0 && !state.fit.fixed[wall]) row.push_back({e.unknown_at(wall), by_R});
        e.add(row, -residual, weight, effects ? &by_effects : nullptr);
    };
    add(1, -1, -epsilon, epsilon, 0, r.momentum, momentum_weight);
    add(1, R, -R, -1, r.approach, r.restitution, restitution_weight);
}

/// Adds the equations of the free mass: it flies with constant velocity from contact to contact,
/// where y = x - side b (43); each impact conserves x' + epsilon y' (36) and has the R of its wall
/// (4). They couple the times of neighbouring impacts.
void add_mass_flights(JointFitState& state, const std::vector<FittedBorder>& borders) {
    const std::vector<MassResidual> residuals = mass_residuals(state, borders);
    const auto jump = [](const MassResidual& r) { return std::abs(r.jump); };
    const auto speed = [](const MassResidual& r) { return std::abs(r.approach); };
    const std::vector<double> speeds = values_of(residuals, speed);
    if (state.effects && !speeds.empty()) {
        state.effects->mean_speed =
            std::accumulate(speeds.begin(), speeds.end(), 0.0) / count_of(speeds);
        for (const int side : {1, -1}) {
            const std::vector<double> at_wall = values_of(residuals, [&](const MassResidual& r) {
                return borders[r.impact].side == side ? speed(r) : nan;
            });
            const double usual = median(at_wall);
            const auto off = [usual](double v) { return v / usual - 1; };
            if (const double scatter = robust_deviation(values_of(at_wall, off)); scatter > 0)
                state.effects->speed_scatter = std::max(state.effects->speed_scatter, scatter);
        }
    }
    // The scatter of the residuals, with a lower bound since no wall is perfectly constant.
    const double of_momentum = std::max(
                     robust_deviation(values_of(residuals, &MassResidual::momentum)),
                     least_momentum * median(values_of(residuals, jump))),
                 of_restitution = std::max(
                     robust_deviation(values_of(residuals, &MassResidual::restitution)),
                     least_restitution * median(speeds));
    for (const MassResidual& r : residuals)
        add_mass_rows(
            state, borders[r.impact], r, state.weight(r.momentum, of_momentum, of_momentum),
            state.weight(r.restitution, of_restitution, of_restitution));
}

/// At each impact x is continuous, and its pulse gives its time. At a release x' is continuous
/// too, and its time follows from the vanishing acceleration.
void add_impacts(JointFitState& state, const IntervalFlows& flows) {
    JointEquations& equations = state.equations;
    std::vector<FittedBorder> borders;
    const RecordStatistics& statistics = state.statistics;
    const double noise = state.record.x.empty() ? statistics.a.noise : statistics.x.noise;
    const double weight = 1 / (continuity_share * continuity_share * noise * noise);
    for (std::size_t k = 0; k < state.borders.size(); ++k) {
        const FittedInterval &from = state.fit.intervals[k], &to = state.fit.intervals[k + 1];
        const MotionRow row = state.end_of(flows, k);
        const Candidate& m = state.borders[k];
        if (state.with_mass) borders.push_back(fitted_border(state, k, row));
        if (m.border == Border::gap) continue;
        add_border_condition(
            state, k, row, &OscillatorMotion::x, row.value.x_dot - to.x_dot, true,
            to.x - row.value.x, weight);
        if (m.border == Border::release) {
            const double change = row.value.x_ddot - state.acceleration_at(to),
                         jerk = jerk_at(state, from, row.value, to.tau),
                         sigma = release_error * std::abs(jerk);
            add_border_condition(
                state, k, row, &OscillatorMotion::x_dot, change, true, to.x_dot - row.value.x_dot,
                weight);
            add_border_condition(
                state, k, row, &OscillatorMotion::x_ddot, jerk, false, -row.value.x_ddot,
                1 / (sigma * sigma));
            continue;
        }
        const double error = std::min(m.pulse_error, statistics.step);
        JointEquations::Row terms = {{equations.time_of(k), 1}};
        double left = 0;
        if (std::isfinite(m.pulse_error)) {
            left = m.pulse_tau - to.tau - state.fit.values[Unknown::pulse_lag];
            if (!state.fit.fixed[Unknown::pulse_lag])
                terms.push_back({equations.unknown_at(Unknown::pulse_lag), 1});
        }
        equations.add(terms, left, 1 / (error * error));
    }
    if (state.with_mass) add_mass_flights(state, borders);
}

/// How the mass slides in a flight with y' = y_dot at its start; the direction changes where x' =
/// y'. deceleration: by friction, times the duration.
Sliding sliding_of(IntervalMotion& motion, double duration, double y_dot, double deceleration) {
    constexpr double fewest = 24, per_tau = 10;
    const int parts = static_cast<int>(std::max(fewest, per_tau * duration));
    Sliding s;
    const auto add = [&](double from, double to, double direction) {
        const double part = direction * (to - from), later = 0.5 * (from + to);
        s.mean += part, s.from_start += part * later, s.to_end += part * (1 - later);
    };
    const auto slip_at = [&](double share, double slid) {
        return y_dot - deceleration * slid - motion.at(share * duration, false).value.x_dot;
    };
    double before = slip_at(0, 0);
    s.first = std::copysign(1.0, before);
    for (int k = 1; k <= parts; ++k) {
        const double from = (k - 1.0) / parts, to = static_cast<double>(k) / parts,
                     after = slip_at(to, s.mean + std::copysign(to - from, before));
        const bool turns = before * after < 0;
        const double turn = turns ? from + (to - from) * before / (before - after) : to;
        add(from, turn, std::copysign(1.0, before));
        if (turns) add(turn, to, std::copysign(1.0, after)), s.turns.push_back(turn * duration);
        before = after;
    }
    return s;
}

/// Sets how the mass slides in each flight, from the motion of the step before.
void set_sliding(JointFitState& state, const IntervalFlows& flows) {
    for (std::size_t k = 0; k + 1 < state.borders.size(); ++k) {
        const int side = state.borders[k].side, next_side = state.borders[k + 1].side;
        FittedInterval& i = state.fit.intervals[k + 1];
        const FittedInterval& next = state.fit.intervals[k + 2];
        const double duration = next.tau - i.tau;
        const double deceleration = state.parameters.friction * duration,
                     lifted = deceleration * i.sliding.to_end;
        i.sliding = {};
        if (!i.sticks && side != 0 && next_side != 0 && duration > 0) {
            const double way = next.x - i.x - state.fit.values[Unknown::b] * (next_side - side);
            IntervalMotion motion(flows.of(i), state.fit.values, state.fit.tau_middle, i);
            i.sliding = sliding_of(motion, duration, way / duration + lifted, deceleration);
        }
        i.pull = state.fit.epsilon * state.parameters.friction;
    }
}

/// Priors; unknowns that keep their values get one that holds them.
void add_priors(JointFitState& state) {
    for (std::size_t k = 0; k < unknowns; ++k) {
        const JointEquations::Row value = {{state.equations.unknown_at(k), 1}};
        const double sigma = state.prior[k], off = state.prior_mean[k] - state.fit.values[k];
        if (is_held(state, k)) state.equations.add(value, 0, 1);
        else if (std::isfinite(sigma)) state.equations.add(value, off, 1 / (sigma * sigma));
    }
}

/// Keeps a given amplitude and a given phase at tau = 0.
void add_known_forcing(JointFitState& state) {
    JointEquations& equations = state.equations;
    const UnknownValues& v = state.fit.values;
    const double sin = v[Unknown::force_sin], cos = v[Unknown::force_cos],
                 amplitude = elementary::hypot(sin, cos),
                 weight = 1 / (known_to * known_to * amplitude * amplitude);
    if (!(amplitude > 0)) return;
    const Eigen::Index of_sin = equations.unknown_at(Unknown::force_sin),
                       of_cos = equations.unknown_at(Unknown::force_cos);
    if (const auto& known = state.forcing.amplitude)
        equations.add(
            {{of_sin, sin / amplitude}, {of_cos, cos / amplitude}}, *known - amplitude, weight);
    if (const auto& known = state.forcing.phase) {
        // The phase in the middle depends on the frequency.
        const double phase = *known + v[Unknown::Omega] * state.fit.tau_middle,
                     along_sin = elementary::cos(phase), along_cos = elementary::sin(phase);
        JointEquations::Row row = {{of_sin, -along_cos}, {of_cos, along_sin}};
        const double by_Omega = -state.fit.tau_middle * (sin * along_sin + cos * along_cos);
        if (!state.fit.fixed[Unknown::Omega])
            row.push_back({equations.unknown_at(Unknown::Omega), by_Omega});
        equations.add(row, sin * along_cos - cos * along_sin, weight);
    }
}

}  // namespace

double JointFitState::weight(double left, double noise, double scale) const {
    const double plain = 1 / (noise * noise), off = std::abs(left) / scale;
    if (is_first_step) return plain;
    if (off > ignored_sigmas && weights_trusted) return 0;
    return off > huber_sigmas ? plain * huber_sigmas / off : plain;
}

void set_equations(JointFitState& state) {
    state.equations = {state.fit.intervals.size(), state.ridge};
    if (state.effects) state.equations.collect_effects(state.effects->size());
    const IntervalFlows flows = state.flows();
    if (state.with_mass && !state.is_first_step && (state.parameters.friction > 0 || state.effects))
        set_sliding(state, flows);
    if (!state.record.x.empty()) add_samples(state, flows, true);
    if (!state.record.x_ddot.empty()) add_samples(state, flows, false);
    if (!state.is_first_step) add_impacts(state, flows);
    add_priors(state);
    if (!state.is_first_step) add_known_forcing(state);
}

}  // namespace vines
