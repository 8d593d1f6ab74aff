#include "core/measurement/joint_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "core/measurement/joint_equations.hpp"
#include "core/measurement/left_over.hpp"
#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// x is continuous at an impact: of the noise of one sample the fit may leave it that much of a
// jump. Far smaller, and the equations lose digits.
constexpr double continuity_share = 0.05;
// No step is larger than about so many times the record's largest values: what no sample says
// anything of stays as it is. A sample says far more.
constexpr double largest_step = 100;
// Steps of Gauss and Newton: one finds the motion for the values as they are, few more the values.
constexpr int most_steps = 9;
// From there on half a step: where weights change with the step, whole ones may go to and fro.
constexpr int first_half_step = 5;
// Converged is what would move no value by more than this share of its standard error, and few
// impacts by more than that share of a step between samples.
constexpr double converged_share = 0.1, converged_move_steps = 0.02, few_moved = 0.01;
// Residuals up to so many deviations count in full, further ones less (Huber), and those beyond
// the second not at all.
constexpr double huber_sigmas = 2.5, ignored_sigmas = 8;
// An impact moves by no more than that many samples in one step.
constexpr double most_move_steps = 1;
// A misfit of three quarters of the noise beside the noise: sqrt(1 + .75^2). Records with the
// assumed signal stay below 1.05.
constexpr double misfit_limit = 1.25;
// A moment of release is told by its condition to so much tau: better than any other.
constexpr double release_error = 1e-4;
// What is known of the forcing holds to that share of its amplitude: far better than any record
// tells it.
constexpr double known_to = 1e-7;
// No step takes frequency and stiffness further from what is given, in deviations of their priors,
// nor the damping beyond that of the largest ratio that validate() takes.
constexpr double most_priors = 40, most_damping = 20;
// Samples beside the pulses that a share of a step reaches beyond what is spoiled.
constexpr double pulse_margin = 0.1;

/// Samples of the acceleration that lie in a pulse.
std::vector<char> in_pulses(
    const MeasuredRecord& r, const std::vector<ImpactMoment>& impacts, double margin) {
    std::vector<char> spoiled(r.tau.size(), 0);
    for (const ImpactMoment& i : impacts)
        for (std::size_t k = first_index(r, i.tau - i.spoiled_before - margin);
             k < r.tau.size() && r.tau[k] < i.tau + i.spoiled_after + margin; ++k)
            spoiled[k] = 1;
    return spoiled;
}

class Fit {
public:
    Fit(const JointFitInput& input, const std::vector<ImpactMoment>& impacts,
        const UnknownValues& start, const JointFit* before, IdentificationProgress& progress)
        : in_(input),
          r_(input.record),
          moments_(impacts),
          progress_(progress),
          prior_mean_(given_unknowns(input.parameters)),
          prior_(priors(input.parameters)),
          fixed_(input.fixed),
          spoiled_(in_pulses(r_, impacts, pulse_margin * input.statistics.step)) {
        fit_.tau_middle = 0.5 * (r_.tau.front() + r_.tau.back());
        fit_.length = r_.tau.back() - r_.tau.front();
        fit_.epsilon = input.parameters.epsilon;
        fit_.values = start;
        // A fit begins before the record, so that a displacement that is late has a start.
        if (before) {
            starts_at_rest_ = false, trusted_ = true;
            fit_.intervals = before->intervals;
            scale_x_ = std::max(before->noise_x, in_.statistics.x.noise);
            scale_a_ = std::max(before->noise_a, in_.statistics.x_ddot.noise);
        } else {
            fit_.intervals.push_back({r_.tau.front() - largest_delay, 0, 0});
            for (const ImpactMoment& i : impacts) fit_.intervals.push_back({i.tau, 0, 0, i.sticks});
        }
        // One over the largest step squared.
        const double size = largest_step * quantile_of_moduli(r_.x.empty() ? r_.x_ddot : r_.x, 1);
        ridge_ = 1 / std::max(size * size, 1e-12);
        fit_.x_left.resize(r_.x.size());
        fit_.a_left.resize(r_.x_ddot.size());
        fix_what_no_sensor_shows();
        fit_.fixed = fixed_;
        fit_.forcing = input.forcing;
    }

    JointFit take() {
        for (int step = 0; step < most_steps; ++step) {
            progress_.look();
            const bool first = starts_at_rest_ && step == 0;
            JointEquations equations = equations_at(first);
            JointEquations::Solution s = equations.solve();
            if (!s.solved || !leads_to_oscillator(equations, s)) break;
            if (step >= first_half_step) s.step *= 0.5;
            fit_.converged = !first && is_small(equations, s);
            if (!first) take_errors(s, equations);
            if (fit_.converged) break;
            take_step(equations, s, first);
            if (in_.one_step) break;
            take_scales();
        }
        meet_at_impacts();
        take_misfits();
        return std::move(fit_);
    }

private:
    void fix_what_no_sensor_shows() {
        const auto fix = [this](std::initializer_list<Unknown> all) {
            for (const Unknown u : all) fixed_[u] = true;
        };
        if (r_.x.empty()) fix({Unknown::x_offset, Unknown::x_drift});
        if (r_.x_ddot.empty()) fix({Unknown::a_offset, Unknown::a_drift});
        if (r_.x.empty() || r_.x_ddot.empty()) fix({Unknown::x_gain});
        const bool any_pulse = std::any_of(moments_.begin(), moments_.end(), [](const auto& m) {
            return std::isfinite(m.pulse_error);
        });
        if (r_.x.empty() || (r_.x_ddot.empty() && !any_pulse)) fix({Unknown::x_delay});
        if (r_.x_ddot.empty() || !any_pulse) fix({Unknown::pulse_lag});
        if (!in_.sides) fix({Unknown::b});
        for (const int side : {1, -1})
            if (!in_.sides || std::count(in_.sides->begin(), in_.sides->end(), side) == 0)
                fix({restitution_at(side)});
    }

    /// A step in no unknown that is fixed, and in the first one none that is not linear in the
    /// motion: there is none yet.
    void forget_fixed(UnknownRow& by_unknowns, bool first) const {
        for (std::size_t k = 0; k < sensed_unknowns; ++k)
            if (stays(k, first)) by_unknowns(static_cast<Eigen::Index>(k)) = 0;
    }
    bool oscillator_moves() const {
        return !fixed_[Unknown::stiffness] || !fixed_[Unknown::damping];
    }
    bool stays(std::size_t unknown, bool first) const {
        return fixed_[unknown] || (first && unknown >= static_cast<std::size_t>(Unknown::x_gain));
    }

    double weight(double left, double noise, double scale, bool first) const {
        const double plain = 1 / (noise * noise);
        if (first) return plain;
        const double off = std::abs(left) / scale;
        if (off > ignored_sigmas && trusted_) return 0;
        return off > huber_sigmas ? plain * huber_sigmas / off : plain;
    }

    /// Visits the samples of a channel that is `late` with the motion there.
    template <class Visit>
    void each_sample(const IntervalFlows& flows, double late, bool accelerate, const Visit& visit) {
        std::size_t i = 0;
        for (std::size_t k = 0; k < r_.tau.size();) {
            const auto here = [&] { return r_.tau[k] - late; };
            const auto next = [&] {
                return i + 1 < fit_.intervals.size() ? fit_.intervals[i + 1].tau : infinity;
            };
            while (here() >= next()) ++i;
            IntervalMotion motion = motion_in(flows, fit_.intervals[i]);
            for (; k < r_.tau.size() && here() < next(); ++k) {
                progress_.tick();
                visit(k, i, motion.at(std::max(0.0, here() - fit_.intervals[i].tau), accelerate));
            }
        }
    }

    IntervalMotion motion_in(const IntervalFlows& flows, const FittedInterval& i) const {
        return {flows.of(i), fit_.values, fit_.tau_middle, i};
    }

    double middle_of(std::size_t k) const { return (r_.tau[k] - fit_.tau_middle) / fit_.length; }

    bool x_is_spoiled(std::size_t interval, double tau) const {
        const auto& i = fit_.intervals;
        return (interval > 0 && tau - i[interval].tau < in_.x_spoiled) ||
               (interval + 1 < i.size() && i[interval + 1].tau - tau < in_.x_spoiled);
    }

    JointEquations equations_at(bool first) {
        JointEquations equations(fit_.intervals.size(), ridge_);
        const IntervalFlows flows(fit_.values, oscillator_moves(), fit_.epsilon);
        Eigen::RowVector2d by_start;
        UnknownRow by_unknowns;
        const auto set = [&](Unknown u, double value) {
            by_unknowns(static_cast<Eigen::Index>(u)) = value;
        };
        const UnknownValues& v = fit_.values;
        if (!r_.x.empty())
            each_sample(
                flows, v[Unknown::x_delay], false,
                [&](std::size_t k, std::size_t i, const MotionRow& row) {
                    const double gain = v[Unknown::x_gain], u = middle_of(k);
                    const double left = r_.x[k] - gain * row.value.x - v[Unknown::x_offset] -
                                        v[Unknown::x_drift] * u;
                    fit_.x_left[k] = left;
                    if (in_.bad_x[k] || x_is_spoiled(i, r_.tau[k] - v[Unknown::x_delay])) return;
                    take_derivatives(row, &OscillatorMotion::x, by_start, by_unknowns);
                    by_start *= gain;
                    by_unknowns *= gain;
                    set(Unknown::x_offset, 1);
                    set(Unknown::x_drift, u);
                    set(Unknown::x_gain, row.value.x);
                    set(Unknown::x_delay, -gain * row.value.x_dot);
                    forget_fixed(by_unknowns, first);
                    equations.add(
                        i, by_start, by_unknowns, left,
                        weight(left, in_.statistics.x.noise, scale_x_, first));
                });
        if (!r_.x_ddot.empty())
            each_sample(flows, 0, true, [&](std::size_t k, std::size_t i, const MotionRow& row) {
                const double u = middle_of(k);
                const double left = r_.x_ddot[k] - row.value.x_ddot - v[Unknown::a_offset] -
                                    v[Unknown::a_drift] * u;
                fit_.a_left[k] = left;
                if (spoiled_[k] || in_.bad_a[k]) return;
                take_derivatives(row, &OscillatorMotion::x_ddot, by_start, by_unknowns);
                set(Unknown::a_offset, 1);
                set(Unknown::a_drift, u);
                forget_fixed(by_unknowns, first);
                equations.add(
                    i, by_start, by_unknowns, left,
                    weight(left, in_.statistics.x_ddot.noise, scale_a_, first));
            });
        if (!first) add_impacts(flows, equations);
        add_priors(equations, first);
        if (!first) add_known_forcing(equations);
        return equations;
    }

    /// x is continuous at each impact, and its pulse tells its moment. At a release x' is
    /// continuous, too, and nothing accelerates the two masses, which tells its moment.
    void add_impacts(const IntervalFlows& flows, JointEquations& equations) {
        std::vector<MetImpact> met;
        const double noise = r_.x.empty() ? in_.statistics.x_ddot.noise : in_.statistics.x.noise;
        const double weight = 1 / (continuity_share * continuity_share * noise * noise);
        for (std::size_t k = 0; k < moments_.size(); ++k) {
            const FittedInterval &from = fit_.intervals[k], &to = fit_.intervals[k + 1];
            const MotionRow row = motion_in(flows, from).at(to.tau - from.tau, true);
            const ImpactMoment& m = moments_[k];
            if (in_.sides) met.push_back(met_impact(m, row, to));
            if (m.border == Border::gap) continue;
            add_meeting(
                k, row, &OscillatorMotion::x, row.value.x_dot - to.x_dot, true, to.x - row.value.x,
                weight, equations);
            if (m.border == Border::release) {
                add_meeting(
                    k, row, &OscillatorMotion::x_dot, row.value.x_ddot - acceleration_at(to), true,
                    to.x_dot - row.value.x_dot, weight, equations);
                const double jerk = jerk_at(from, row.value, to.tau),
                             sigma = release_error * std::abs(jerk);
                add_meeting(
                    k, row, &OscillatorMotion::x_ddot, jerk, false, -row.value.x_ddot,
                    1 / (sigma * sigma), equations);
                continue;
            }
            const double error = std::min(m.pulse_error, in_.statistics.step);
            if (!std::isfinite(m.pulse_error)) {
                equations.add({{equations.moment_of(k), 1}}, 0, 1 / (error * error));
                continue;
            }
            std::vector<JointEquations::Term> terms = {{equations.moment_of(k), 1}};
            if (!fixed_[Unknown::pulse_lag])
                terms.push_back({equations.unknown_at(Unknown::pulse_lag), 1});
            equations.add(
                terms, m.pulse_tau - to.tau - fit_.values[Unknown::pulse_lag], 1 / (error * error));
        }
        if (in_.sides) add_mass(met, equations);
    }

    /// Of the end of interval k, `row`, one of x, x' and x'' has a condition, which moves so much
    /// with the moment; `meets`: to be that of the start of the next one.
    void add_meeting(
        std::size_t k, const MotionRow& row, double OscillatorMotion::* member, double by_moment,
        bool meets, double left, double weight, JointEquations& equations) const {
        Eigen::RowVector2d by_start;
        UnknownRow by_unknowns;
        take_derivatives(row, member, by_start, by_unknowns);
        forget_fixed(by_unknowns, false);
        std::vector<JointEquations::Term> terms = {
            {equations.start_of(k), by_start(0)},
            {equations.start_of(k) + 1, by_start(1)},
            {equations.moment_of(k), by_moment}};
        if (meets)
            terms.push_back(
                {equations.start_of(k + 1) + (member == &OscillatorMotion::x_dot ? 1 : 0), -1});
        for (std::size_t g = 0; g < sensed_unknowns; ++g) {
            const double by = by_unknowns(static_cast<Eigen::Index>(g));
            if (by != 0) terms.push_back({equations.unknown_at(g), by});
        }
        equations.add(terms, left, weight);
    }

    MetImpact met_impact(
        const ImpactMoment& moment, const MotionRow& row, const FittedInterval& to) const {
        MetImpact m{
            .flies = moment.border == Border::impact && !moment.sticks,
            .tau = to.tau,
            .x = to.x,
            .x_dot_before = row.value.x_dot,
            .x_dot_after = to.x_dot,
            .x_ddot_before = row.value.x_ddot,
            .x_ddot_after = acceleration_at(to),
            .before_by_start = {},
            .before_by_unknowns = {}};
        take_derivatives(row, &OscillatorMotion::x_dot, m.before_by_start, m.before_by_unknowns);
        forget_fixed(m.before_by_unknowns, false);
        return m;
    }

    void add_mass(const std::vector<MetImpact>& met, JointEquations& equations) {
        const double epsilon = in_.parameters.epsilon;
        const std::vector<MassResidual> residuals =
            mass_residuals(epsilon, *in_.sides, met, fit_.values);
        const MassScatter scatter = scatter_of(residuals);
        const auto weight_of = [&](double left, double sigma) {
            return weight(left, sigma, sigma, false);
        };
        for (const MassResidual& r : residuals)
            add_mass_rows(
                epsilon, *in_.sides, met, fit_.values, fixed_, r,
                weight_of(r.momentum, scatter.momentum),
                weight_of(r.restitution, scatter.restitution), equations);
    }

    void add_priors(JointEquations& equations, bool first) const {
        for (std::size_t k = 0; k < unknowns; ++k) {
            if (stays(k, first)) equations.add_prior(k, 0, 1);  // nothing else moves it
            else if (std::isfinite(prior_[k]))
                equations.add_prior(
                    k, prior_mean_[k] - fit_.values[k], 1 / (prior_[k] * prior_[k]));
        }
    }

    /// Rows by which its amplitude and its phase at tau = 0 stay what they are known to be.
    void add_known_forcing(JointEquations& equations) const {
        const UnknownValues& v = fit_.values;
        const double sin = v[Unknown::force_sin], cos = v[Unknown::force_cos],
                     amplitude = elementary::hypot(sin, cos),
                     weight = 1 / (known_to * known_to * amplitude * amplitude);
        if (!(amplitude > 0)) return;
        const Eigen::Index of_sin = equations.unknown_at(Unknown::force_sin),
                           of_cos = equations.unknown_at(Unknown::force_cos);
        if (const auto& known = in_.forcing.amplitude)
            equations.add(
                {{of_sin, sin / amplitude}, {of_cos, cos / amplitude}}, *known - amplitude, weight);
        if (const auto& known = in_.forcing.phase) {
            // That of the middle moves with the frequency.
            const double phase = *known + v[Unknown::Omega] * fit_.tau_middle,
                         along_sin = elementary::cos(phase), along_cos = elementary::sin(phase);
            std::vector<JointEquations::Term> row = {{of_sin, -along_cos}, {of_cos, along_sin}};
            if (!fixed_[Unknown::Omega])
                row.push_back(
                    {equations.unknown_at(Unknown::Omega),
                     -fit_.tau_middle * (sin * along_sin + cos * along_cos)});
            equations.add(row, sin * along_cos - cos * along_sin, weight);
        }
    }

    /// Whether a step moves no value by more than a share of its error, and hardly an impact.
    bool is_small(const JointEquations& equations, const JointEquations::Solution& s) const {
        for (std::size_t k = 0; k < unknowns; ++k) {
            const auto at = static_cast<Eigen::Index>(k);
            if (!fixed_[k] && std::abs(s.step(equations.unknown_at(k))) >
                                  converged_share * std::sqrt(s.covariance(at, at)))
                return false;
        }
        std::size_t moved = 0;
        for (std::size_t k = 0; k < moments_.size(); ++k)
            moved += std::abs(s.step(equations.moment_of(k))) >
                     converged_move_steps * in_.statistics.step;
        return static_cast<double>(moved) <= few_moved * static_cast<double>(moments_.size());
    }

    /// Whether a step leads to such an oscillator as is given. Wild samples ask for any, and a flow
    /// of that may take any time.
    bool leads_to_oscillator(
        const JointEquations& equations, const JointEquations::Solution& s) const {
        const auto after = [&](Unknown u) {
            return fit_.values[u] + (fixed_[u] ? 0 : s.step(equations.unknown_at(u)));
        };
        const auto is_near = [&](Unknown u) {
            return std::abs(after(u) - prior_mean_[u]) <= most_priors * prior_[u];
        };
        return is_near(Unknown::Omega) && is_near(Unknown::stiffness) &&
               std::abs(after(Unknown::damping)) < most_damping;
    }

    void take_step(const JointEquations& equations, const JointEquations::Solution& s, bool first) {
        for (std::size_t k = 0; k < unknowns; ++k)
            if (!fixed_[k]) fit_.values[k] += s.step(equations.unknown_at(k));
        fit_.values[Unknown::x_delay] =
            std::clamp(fit_.values[Unknown::x_delay], -largest_delay, largest_delay);
        for (std::size_t i = 0; i < fit_.intervals.size(); ++i) {
            FittedInterval& interval = fit_.intervals[i];
            interval.x += s.step(equations.start_of(i));
            interval.x_dot += s.step(equations.start_of(i) + 1);
        }
        if (first) return;
        for (std::size_t k = 0; k < moments_.size(); ++k) move(k, s.step(equations.moment_of(k)));
    }

    /// Moves an impact, and the start of its interval with it.
    void move(std::size_t impact, double by) {
        const double most = most_move_steps * in_.statistics.step;
        FittedInterval& i = fit_.intervals[impact + 1];
        const double last =
            impact + 2 < fit_.intervals.size() ? fit_.intervals[impact + 2].tau : r_.tau.back();
        const double to = std::clamp(
            i.tau + std::clamp(by, -most, most),
            std::min(i.tau, fit_.intervals[impact].tau + 1e-3 * most),
            std::max(i.tau, last - 1e-3 * most));
        const double s = to - i.tau;
        const double x_ddot = acceleration_at(i);
        i.x += s * (i.x_dot + 0.5 * s * x_ddot);
        i.x_dot += s * x_ddot;
        i.tau = to;
    }

    double mass_of(const FittedInterval& i) const { return i.is_stuck ? 1 + fit_.epsilon : 1; }

    double acceleration_at(const FittedInterval& i) const {
        const UnknownValues& v = fit_.values;
        const double angle = v[Unknown::Omega] * (i.tau - fit_.tau_middle);
        return (-v[Unknown::stiffness] * i.x - v[Unknown::damping] * i.x_dot +
                v[Unknown::force_sin] * elementary::sin(angle) +
                v[Unknown::force_cos] * elementary::cos(angle)) /
               mass_of(i);
    }
    /// Of the motion in an interval at a moment.
    double jerk_at(const FittedInterval& i, const OscillatorMotion& m, double tau) const {
        const UnknownValues& v = fit_.values;
        const double angle = v[Unknown::Omega] * (tau - fit_.tau_middle);
        return (-v[Unknown::stiffness] * m.x_dot - v[Unknown::damping] * m.x_ddot +
                v[Unknown::Omega] * (v[Unknown::force_sin] * elementary::cos(angle) -
                                     v[Unknown::force_cos] * elementary::sin(angle))) /
               mass_of(i);
    }

    /// The deviations of what is left, by which the next step weighs it.
    void take_scales() {
        std::vector<double> x, a;
        for (std::size_t k = 0; k < fit_.x_left.size(); ++k)
            if (!in_.bad_x[k]) x.push_back(fit_.x_left[k]);
        for (std::size_t k = 0; k < fit_.a_left.size(); ++k)
            if (!in_.bad_a[k] && !spoiled_[k]) a.push_back(fit_.a_left[k]);
        scale_x_ = std::max(robust_deviation(std::move(x)), in_.statistics.x.noise);
        scale_a_ = std::max(robust_deviation(std::move(a)), in_.statistics.x_ddot.noise);
        ++scales_taken_;
        // The first are of a motion of zero.
        trusted_ = scales_taken_ > 2;
    }

    void take_errors(const JointEquations::Solution& s, JointEquations& equations) {
        for (std::size_t k = 0; k < unknowns; ++k) {
            const auto at = static_cast<Eigen::Index>(k);
            fit_.errors[k] = fixed_[k] ? 0 : std::sqrt(s.covariance(at, at));
        }
        own_ = std::move(equations.own());
    }

    void meet_at_impacts() {
        const IntervalFlows flows(fit_.values, oscillator_moves(), fit_.epsilon);
        // What each interval says by itself, with the values of all.
        std::vector<Eigen::Matrix2d> covariance;
        std::vector<Eigen::Vector2d> own;
        for (std::size_t i = 0; i < fit_.intervals.size(); ++i) {
            Eigen::Matrix2d N = ridge_ * Eigen::Matrix2d::Identity();
            Eigen::Vector2d g = Eigen::Vector2d::Zero();
            if (i < own_.size()) N += own_[i].N, g = own_[i].g;
            covariance.push_back(N.inverse());
            own.emplace_back(
                Eigen::Vector2d(fit_.intervals[i].x, fit_.intervals[i].x_dot) +
                covariance.back() * g);
        }
        const auto error = [](double variance) {
            return variance > 0 ? std::sqrt(variance) : infinity;
        };
        Eigen::RowVector2d by_x, by_x_dot;
        UnknownRow unused;
        for (std::size_t k = 0; k < moments_.size(); ++k) {
            const FittedInterval &from = fit_.intervals[k], &to = fit_.intervals[k + 1];
            const MotionRow row = motion_in(flows, from).at(to.tau - from.tau, true);
            take_derivatives(row, &OscillatorMotion::x, by_x, unused);
            take_derivatives(row, &OscillatorMotion::x_dot, by_x_dot, unused);
            const Eigen::Vector2d moved(own[k](0) - from.x, own[k](1) - from.x_dot);
            fit_.impacts.push_back(
                {.tau = to.tau,
                 .border = moments_[k].border,
                 .x = to.x,
                 .x_dot_before = row.value.x_dot,
                 .x_dot_after = to.x_dot,
                 .x_ddot_before = row.value.x_ddot,
                 .x_ddot_after = acceleration_at(to),
                 .x_jump = row.value.x + by_x * moved - own[k + 1](0),
                 .x_jump_error =
                     error(by_x * covariance[k] * by_x.transpose() + covariance[k + 1](0, 0)),
                 .x_dot_jump_error = error(
                     by_x_dot * covariance[k] * by_x_dot.transpose() + covariance[k + 1](1, 1))});
        }
    }

    /// Of what a fit leaves of a sensor: `left` beside the pulses.
    LeftOver left_over(
        const std::vector<double>& left, const SignalStatistics& signal,
        const std::vector<char>& bad) const {
        std::vector<char> odd(spoiled_);
        for (std::size_t k = 0; k < left.size(); ++k)
            if (bad[k]) odd[k] = 1;
        return vines::left_over(r_.tau, left, odd, in_.statistics.step, signal);
    }

    void take_misfits() {
        double uncertain = 1;
        const auto take = [&](const LeftOver& l, double& noise, double& misfit) {
            noise = l.noise, misfit = l.misfit, uncertain = std::max(uncertain, l.uncertainty);
        };
        fit_.noise_x = fit_.noise_a = fit_.misfit_x = fit_.misfit_a = nan;
        if (!r_.x.empty())
            take(left_over(fit_.x_left, in_.statistics.x, in_.bad_x), fit_.noise_x, fit_.misfit_x);
        if (!r_.x_ddot.empty())
            take(
                left_over(fit_.a_left, in_.statistics.x_ddot, in_.bad_a), fit_.noise_a,
                fit_.misfit_a);
        // What is left beyond what the fit took for noise makes all less certain.
        for (double& e : fit_.errors) e *= uncertain;
    }

    const JointFitInput& in_;
    const MeasuredRecord& r_;
    const std::vector<ImpactMoment>& moments_;
    IdentificationProgress& progress_;
    const UnknownValues prior_mean_, prior_;
    FixedUnknowns fixed_;
    const std::vector<char> spoiled_;  // samples of the acceleration in pulses
    bool starts_at_rest_ = true;
    double ridge_ = 0;
    double scale_x_ = infinity, scale_a_ = infinity;
    int scales_taken_ = 0;
    bool trusted_ = false;
    std::vector<JointEquations::OfInterval> own_;
    JointFit fit_;
};

}  // namespace

JointFit fit_jointly(
    const JointFitInput& input, const std::vector<ImpactMoment>& impacts,
    const UnknownValues& values, const JointFit* before, IdentificationProgress& progress) {
    return Fit(input, impacts, values, before, progress).take();
}

bool explains(const JointFit& fit) {
    return !(fit.misfit_x > misfit_limit) && !(fit.misfit_a > misfit_limit);
}

std::vector<OscillatorMotion> motion_at(const JointFit& fit, const std::vector<double>& moments) {
    const IntervalFlows flows(fit.values, false, fit.epsilon);
    std::vector<OscillatorMotion> motions;
    motions.reserve(moments.size());
    std::size_t i = 0;
    for (std::size_t k = 0; k < moments.size();) {
        const auto next = [&] {
            return i + 1 < fit.intervals.size() ? fit.intervals[i + 1].tau : infinity;
        };
        while (moments[k] >= next()) ++i;
        const FittedInterval& interval = fit.intervals[i];
        IntervalMotion motion(flows.of(interval), fit.values, fit.tau_middle, interval);
        for (; k < moments.size() && moments[k] < next(); ++k)
            motions.push_back(motion.at(std::max(0.0, moments[k] - interval.tau), true).value);
    }
    return motions;
}

}  // namespace vines
