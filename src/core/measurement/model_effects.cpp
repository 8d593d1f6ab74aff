// Effects outside the model of a record (unknowns.hpp): tests on the residual of a fit.
//
// Each effect changes the predicted samples and states linearly, by a few unknown sizes e. With the
// equations N z = g of the fit, B = J^T W R for the derivatives R by the sizes, and r the residual,
// the sizes and the change of all unknowns that including the effect would cause are
//
//     S = R^T W R - B^T N^-1 B,   e = S^-1 (R^T W r - B^T z),   change = -N^-1 B e.
//
// The effect is present if e S e is far above the number of its sizes, and matters if the change
// exceeds the standard errors.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/measurement/joint_equations.hpp"

namespace vines {

namespace {

// Slow variations over the record: harmonics of its length, next to a parabola of the displacement,
// or a slope of the forcing's amplitude; a slope of its phase is its frequency, an unknown.
constexpr Eigen::Index slow_harmonics = 4, slow_columns = 2 * slow_harmonics + 1,
                       forcing_columns = 4 * slow_harmonics + 1;
// A statistic exceeds its degrees of freedom by this many standard deviations and this much if the
// effect is present; it matters if it moves b, R or the forcing by this many standard errors.
constexpr double sure_deviations = 6, sure = 25, matters = 1;
constexpr double most_lead = 0.5;  // largest phase lead of a high pass, rad
// Relative scatter of the speeds at a wall from which on they determine a slope of R: that of a
// periodic motion comes from the noise.
constexpr double least_scatter = 0.03;

Flow harmonic_flow(const JointFitState& state, double times) {
    const UnknownValues& v = state.fit.values;
    return {v[Unknown::stiffness], v[Unknown::damping], 1, times * v[Unknown::Omega]};
}

/// S and the right side of the equations of all sizes, from the last step, solved with them.
struct EffectEquations {
    explicit EffectEquations(const JointEquations& e)
        : S(e.effects.squares.selfadjointView<Eigen::Lower>().toDenseMatrix() -
            e.effects.mixed.transpose() * e.effects.solved),
          g(e.effects.right - e.effects.mixed.transpose() * e.step) {}

    Eigen::MatrixXd S;
    Eigen::VectorXd g;
};

/// The effects that are present and matter for b, R or the forcing. `factor`: of standard errors.
std::vector<FittedEffect> tested_effects(
    const JointFitState& state, const EffectDerivatives& effects, const EffectEquations& of_effects,
    double factor) {
    const JointEquations& e = state.equations;
    const JointEquations::EffectSums& sums = e.effects;
    const auto& [S, g] = of_effects;
    std::vector<FittedEffect> found;
    for (const EffectDerivatives::Columns& c : effects.columns()) {
        if (c.effect == Effect::given_mass_ratio || c.effect == Effect::given_oscillator) continue;
        if (c.effect == Effect::R_varies && effects.speed_scatter < least_scatter) continue;
        // Scaled: the sizes have different units.
        const Eigen::VectorXd scale =
            S.diagonal().segment(c.first, c.count).cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
        Eigen::MatrixXd scaled =
            scale.asDiagonal() * S.block(c.first, c.first, c.count, c.count) * scale.asDiagonal();
        scaled.diagonal().array() += 1e-9;
        const Eigen::VectorXd right = scale.asDiagonal() * g.segment(c.first, c.count),
                              z = scaled.ldlt().solve(right);
        const auto n = static_cast<double>(c.count);
        const double statistic = right.dot(z) / (factor * factor);
        if (!(statistic > n + sure_deviations * std::sqrt(2 * n) + sure)) continue;
        const Eigen::VectorXd size = scale.asDiagonal() * z;
        FittedEffect effect{c.effect, size.norm(), {}};
        for (std::size_t k = 0; k < unknowns; ++k)
            if (!state.fit.fixed[k])
                effect.change[k] =
                    -(sums.solved.row(e.unknown_at(k)).segment(c.first, c.count) * size).value();
        double most = 0;
        for (const Unknown u :
             {Unknown::b, Unknown::R_plus, Unknown::R_minus, Unknown::force_sin,
              Unknown::force_cos})
            if (!state.fit.fixed[u])
                most = std::max(most, std::abs(effect.change[u]) / state.fit.errors[u]);
        // A slope of R leaves its mean as it is.
        if (most > matters || c.effect == Effect::R_varies) found.push_back(effect);
    }
    return found;
}

/// Fits the laws of the ball. Returns the standard errors of the unknowns that follow from theirs.
UnknownValues fit_laws(
    JointFitState& state, const EffectDerivatives& effects, const EffectEquations& of_effects,
    double factor) {
    std::vector<Eigen::Index> columns;
    if (state.laws.friction) columns.push_back(effects.first_of(Effect::friction));
    if (state.laws.R_slope) columns.push_back(effects.first_of(Effect::R_varies));
    const Eigen::VectorXd g = of_effects.g(columns);
    const Eigen::MatrixXd covariance = of_effects.S(columns, columns).inverse();
    const Eigen::VectorXd change = covariance * g,
                          error = factor * covariance.diagonal().cwiseSqrt();
    LawChanges& laws = state.fit.laws;
    laws = {.mean_speed = effects.mean_speed, .chi_square = g.dot(change) / (factor * factor)};
    if (state.laws.friction) laws.friction = change(0), laws.friction_error = error(0);
    const Eigen::Index last = change.size() - 1;
    if (state.laws.R_slope) laws.R_slope = change(last), laws.R_slope_error = error(last);
    UnknownValues errors{};
    for (std::size_t k = 0; k < unknowns; ++k) {
        if (state.fit.fixed[k]) continue;
        const Eigen::VectorXd by =
            state.equations.effects.solved.row(state.equations.unknown_at(k))(columns);
        errors[k] = factor * std::sqrt(by.dot(covariance * by));
    }
    return errors;
}

/// Standard errors that follow from those of the given masses, stiffness and damping, and from the
/// noise of a channel of the forcing.
UnknownValues propagated_uncertainty(const JointFitState& state, const EffectDerivatives& effects) {
    const UnknownValues& v = state.fit.values;
    const double amplitude = elementary::hypot(v[Unknown::force_sin], v[Unknown::force_cos]);
    const MeasuredLoad* load = state.forcing.load.get();
    const GivenUncertainty& given = state.uncertainty;
    const Eigen::Index mass = effects.first_of(Effect::given_mass_ratio),
                       oscillator = effects.first_of(Effect::given_oscillator);
    UnknownValues errors{};
    for (std::size_t k = 0; k < unknowns; ++k) {
        if (state.fit.fixed[k]) continue;
        const auto by = state.equations.effects.solved.row(state.equations.unknown_at(k));
        const auto add = [&](double error) { errors[k] = elementary::hypot(errors[k], error); };
        const auto add_columns = [&](Eigen::Index first, Eigen::Index count, double error) {
            add(error * amplitude * by.segment(first, count).norm());
        };
        if (load) {
            add_columns(effects.first_of(Effect::second_harmonic), 2, load->error_of(2));
            add_columns(effects.first_of(Effect::third_harmonic), 2, load->error_of(3));
            // Slow variations of the fundamental: the mean square of a slow harmonic is 1/2.
            add_columns(
                effects.first_of(Effect::forcing_varies) + 1, forcing_columns - 1,
                std::numbers::sqrt2 * load->error_of(1));
        }
        if (mass < 0) continue;
        // The fit determines stiffness and damping where it is free to do so.
        const double ratio = state.fit.epsilon * by(mass),
                     stiffness = state.fit.fixed[Unknown::stiffness] ? by(oscillator) : 0,
                     damping = state.fit.fixed[Unknown::damping]
                                   ? v[Unknown::damping] * by(oscillator + 1)
                                   : 0;
        for (const double error :
             {given.m2 * ratio, given.m1 * (ratio + stiffness + damping), given.k1 * stiffness,
              given.c1 * damping})
            add(error);
    }
    return errors;
}

}  // namespace

EffectDerivatives::EffectDerivatives(const JointFitState& state)
    : state_(state),
      interval_(state.fit.intervals.size()),
      harmonics_{harmonic_flow(state, 2), harmonic_flow(state, 3)} {
    Eigen::Index size = 0;
    const auto add = [&](Effect effect, Eigen::Index count) {
        columns_.push_back({effect, size, count});
        size += count;
    };
    const bool both = !state.record.x.empty() && !state.record.x_ddot.empty();
    add(Effect::second_harmonic, 2);
    add(Effect::third_harmonic, 2);
    add(Effect::forcing_varies, forcing_columns);
    add(Effect::stiffness_varies, 1);
    if (!state.record.x.empty()) add(Effect::displacement_drifts, slow_columns);
    if (both) add(Effect::high_pass, 1), add(Effect::clocks_differ, 1);
    add(Effect::friction, 1), add(Effect::R_varies, 1);
    if (state.uncertainty.any()) add(Effect::given_mass_ratio, 1), add(Effect::given_oscillator, 2);
    for (std::size_t k = 0; k < state.mains.size(); ++k) add(Effect::hum, both ? 4 : 2);
    row_ = Eigen::VectorXd::Zero(size);
    // A fit without a high pass takes its phase lead at the forcing frequency for a delay.
    const double Omega = state.fit.values[Unknown::Omega],
                 lead = std::clamp(Omega * state.fit.values[Unknown::x_delay], 0.0, most_lead);
    corner_ = Omega * elementary::sin(lead) / elementary::cos(lead);
}

Eigen::Index EffectDerivatives::first_of(Effect effect) const {
    const auto at = std::ranges::find(columns_, effect, &Columns::effect);
    return at == columns_.end() ? -1 : at->first;
}

/// Sets the columns from `first` on to harmonics of u in [-.5, .5], times a factor.
void EffectDerivatives::slow(double u, Eigen::Index first, double factor) {
    for (Eigen::Index k = 0; k < slow_harmonics; ++k) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(k + 1) * u;
        row_(first + 2 * k) = factor * elementary::sin(angle);
        row_(first + 2 * k + 1) = factor * elementary::cos(angle);
    }
}

const Eigen::VectorXd& EffectDerivatives::motion(
    std::size_t i, double tau, const MotionRow& row, double OscillatorMotion::* member) {
    const FittedInterval& from = state_.fit.intervals[i];
    const UnknownValues& v = state_.fit.values;
    const double since_middle = from.tau - state_.fit.tau_middle;
    row_.setZero();
    // The first columns: harmonics of the forcing.
    for (std::size_t h = 0; h < harmonics_.size(); ++h) {
        if (i != interval_) {
            const auto unit =
                unit_motions(static_cast<double>(h + 2) * v[Unknown::Omega] * since_middle);
            motions_[h].emplace(harmonics_[h], std::array{unit[2], unit[3]});
        }
        const auto parts =
            motions_[h]->at(std::max(0.0, tau - from.tau), member == &OscillatorMotion::x_ddot);
        row_(2 * h) = parts[0].*member, row_(2 * h + 1) = parts[1].*member;
    }
    interval_ = i;
    // The forcing hardly changes within an interval.
    const double u = since_middle / state_.fit.length, sin = row.parts[2].*member,
                 cos = row.parts[3].*member, f_s = v[Unknown::force_sin],
                 f_c = v[Unknown::force_cos];
    const Eigen::Index varies = first_of(Effect::forcing_varies);
    row_(varies) = u * (f_s * sin + f_c * cos) / elementary::hypot(f_s, f_c);
    slow(u, varies + 1, sin);
    slow(u, varies + 1 + 2 * slow_harmonics, cos);
    // -x^3 acts on the fundamental like an additional stiffness 3/4 amplitude^2.
    const double squared =
        from.x * from.x + from.x_dot * from.x_dot / (v[Unknown::Omega] * v[Unknown::Omega]);
    row_(first_of(Effect::stiffness_varies)) = 0.75 * squared * (row.by_stiffness.*member);
    if (const Eigen::Index at = first_of(Effect::given_oscillator); at >= 0)
        row_(at) = row.by_stiffness.*member, row_(at + 1) = row.by_damping.*member;
    // The ball pulls with epsilon times its friction: the response to a constant force.
    const double response = (member == &OscillatorMotion::x ? 1 : 0) - row.parts[0].*member;
    row_(first_of(Effect::friction)) =
        state_.fit.epsilon * from.sliding.mean * response / v[Unknown::stiffness];
    return row_;
}

const Eigen::VectorXd& EffectDerivatives::sample(
    bool of_x, std::size_t i, double tau, const MotionRow& row) {
    const UnknownValues& v = state_.fit.values;
    const double since_middle = tau - state_.fit.tau_middle;
    if (of_x) {
        const double gain = v[Unknown::x_gain], u = since_middle / state_.fit.length;
        motion(i, tau - v[Unknown::x_delay], row, &OscillatorMotion::x);
        row_ *= gain;
        const Eigen::Index drift = first_of(Effect::displacement_drifts);
        row_(drift) = u * u;
        slow(u, drift + 1, 1);
        if (const Eigen::Index at = first_of(Effect::clocks_differ); at >= 0)
            row_(at) = -gain * row.value.x_dot * u;
    } else {
        motion(i, tau, row, &OscillatorMotion::x_ddot);
        // A high pass with corner h subtracts h/(s + h) of the acceleration; exact at the forcing
        // frequency, where the acceleration is -Omega^2 x.
        if (const Eigen::Index at = first_of(Effect::high_pass); at >= 0) {
            const double ratio = corner_ / v[Unknown::Omega];
            row_(at) = (corner_ * row.value.x - row.value.x_dot) / (1 + ratio * ratio);
        }
    }
    // The last columns: two for each hum and sensor.
    for (std::size_t k = 0; k < state_.mains.size(); ++k) {
        const Eigen::Index count = columns_.back().count,
                           first = columns_[columns_.size() - state_.mains.size() + k].first,
                           at = first + (of_x ? 0 : count - 2);
        const double angle = state_.mains[k] * since_middle;
        row_(at) = elementary::sin(angle), row_(at + 1) = elementary::cos(angle);
    }
    return row_;
}

double EffectDerivatives::flight(std::size_t p, double sign) const {
    const FittedInterval& i = state_.fit.intervals[p + 1];
    const double duration = state_.fit.intervals[p + 2].tau - i.tau;
    return duration * (sign > 0 ? i.sliding.to_end : -i.sliding.from_start);
}

void test_effects(JointFitState& state) {
    EffectDerivatives derivatives(state);
    state.effects = &derivatives;
    set_equations(state);
    if (!state.equations.solve()) return;
    // evaluate_residual() scaled the errors.
    const double factor = state.fit.errors[Unknown::Omega] / state.equations.errors[Unknown::Omega];
    const double widened = std::isfinite(factor) && factor > 1 ? factor : 1;
    const EffectEquations of_effects(state.equations);
    state.fit.effects = tested_effects(state, derivatives, of_effects, widened);
    const auto widen = [&state](const UnknownValues& by) {
        for (std::size_t k = 0; k < unknowns; ++k)
            state.fit.errors[k] = elementary::hypot(state.fit.errors[k], by[k]);
    };
    for (const FittedEffect& e : state.fit.effects) widen(e.change);
    widen(propagated_uncertainty(state, derivatives));
    if (state.laws.any()) widen(fit_laws(state, derivatives, of_effects, widened));
}

}  // namespace vines
