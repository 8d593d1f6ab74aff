#include "core/measures/energy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vines {

namespace {

constexpr double longest_decay = 1e6;  // decays that take longer are not reported, tau

// Relative tolerance of the bisection: a few ulps of tau.
constexpr double time_rounding = 1e-15;

// A step or a cycle can end with a stretch, up to this much of tau.
constexpr double step_rounding = 1e-9;

/// Time after tau_start at which a non-increasing energy reaches `level`; bisects 0 to `high`.
template <class EnergyAt>
double crossing_time(EnergyAt energy_at, double level, double high, double tau_start) {
    double low = 0;
    while (high - low > time_rounding * (tau_start + high)) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        (energy_at(middle) > level ? low : high) = middle;
    }
    return tau_start + high;
}

struct DecayLevel {
    std::optional<double> DecayTimes::* time;
    double fraction;  ///< of the energy at the start
};
constexpr DecayLevel decay_levels[] = {{&DecayTimes::half, 0.5}, {&DecayTimes::tenth, 0.1}};

}  // namespace

double energy_of(const Parameters& p, const State& s) {
    return 0.5 * (s.x_dot * s.x_dot + s.x * s.x + p.epsilon * s.y_dot * s.y_dot) -
           p.epsilon * p.gravity * s.y;
}

void Energy::on_stretch(const Stretch& stretch) {
    const auto [from, to] = stretch.within(window_);
    if (!(from < to)) return;
    if (!parameters_.has_straight_flights()) return add_curved(stretch, from, to);
    const bool is_stuck = stretch.sticking_side != 0;
    if (is_stuck && !sticking_) sticking_ = Law{Flow::shared_sticking(parameters_)};
    const Law& law = is_stuck ? *sticking_ : free_;
    const Oscillation begin = from > 0 ? stretch.flow.after(stretch.start, from) : stretch.start;
    if (duration_ == 0 && impacts_ == 0)
        start_ = energy_of(
            parameters_, {begin.x_dot, begin.x, is_stuck ? begin.x_dot : stretch.y_dot, 0});
    const bool in_closed_form = law.antiderivative && duration_ >= law.antiderivative->settled();
    // F cancels between stretches that follow the same law.
    if (duration_ == 0 || last_.is_stuck != is_stuck || last_.in_closed_form != in_closed_form) {
        sum_ = integrals();
        if (in_closed_form) sum_ -= law.antiderivative->at(begin);
    }
    last_ = {begin, to - from, stretch.y_dot, is_stuck, in_closed_form};
    // A step may end with the stretch, up to rounding.
    if (next_step_ <= stretch.tau + to + step_rounding)
        add_steps(law, begin, stretch.tau + from, to - from);
    sum_ += in_closed_form ? law.antiderivative->over_time(to - from)
                           : law.quadrature->over(begin, to - from);
    peak_ = peak_beyond(peak_, *law.flow, begin, to - from);
    duration_ += to - from;
}

/// The same under gravity, friction or a load, by Gauss's rule: exact to rounding over two cells.
void Energy::add_curved(const Stretch& stretch, double from, double to) {
    constexpr double points[] = {
        0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
    constexpr double weights[] = {
        0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
    const double widest = 2 * stretch.flow.cell();
    const Forces& forces = *stretch.forces;
    const auto add = [&](double begin, double end) {
        const double half = 0.5 * (end - begin), middle = begin + half;
        for (int k = 0; k < 8; ++k) {
            const double s = middle + (k % 2 == 0 ? half : -half) * points[k / 2];
            const Oscillation o = stretch.flow.after(stretch.start, s);
            const State at = stretch.at(s, o);
            const double weight = half * weights[k / 2], x = at.x - forces.base.at(s);
            sum_(x_squared) += weight * x * x;
            work_ += weight * at.x_dot * forces.load.at(s);
            sum_(x_dot_squared) += weight * at.x_dot * at.x_dot;
            sum_(x_dot_sin) += weight * at.x_dot * o.sin_theta;
        }
    };
    const auto slid = [&](double begin, double end) {
        if (parameters_.friction == 0 || stretch.is_joint()) return 0.0;
        const State a = stretch.at(begin), b = stretch.at(end);
        return parameters_.epsilon * parameters_.friction * std::abs((b.x - b.y) - (a.x - a.y));
    };
    if (duration_ == 0 && impacts_ == 0) start_ = energy_of(parameters_, stretch.at(from));
    for (double s = from; s < to;) {
        const double step_end = next_step_ - stretch.tau;
        double next = std::min(to, s + widest);
        const bool ends_step = step_end <= next + step_rounding;
        if (ends_step) next = std::clamp(step_end, s, to);
        add(s, next);
        friction_ += slid(s, next);
        if (ends_step) {
            at_steps_.push_back({sum_(x_squared), sum_(x_dot_squared), impacts_, friction_});
            next_step_ = steps_.end_of(at_steps_.size());
            if (next == s && !(step_end < to)) break;
        }
        s = next;
    }
    peak_ = peak_beyond(
        peak_, stretch.flow, stretch.start, sum(forces.shift, forces.base, -1), from, to);
    end_ = stretch.at(to);
    duration_ += to - from;
}

/// Appends the sums at the ends of steps within a part, which sum_ does not yet contain.
void Energy::add_steps(const Law& law, const Oscillation& begin, double tau, double duration) {
    do {
        const double part = std::clamp(next_step_ - tau, 0.0, duration);
        const Integrals sum =
            sum_ + (last_.in_closed_form ? law.antiderivative->over_time(part) +
                                               law.antiderivative->at(law.flow->after(begin, part))
                                         : law.quadrature->over(begin, part));
        at_steps_.push_back({sum(x_squared), sum(x_dot_squared), impacts_, 0});
        next_step_ = steps_.end_of(at_steps_.size());
    } while (next_step_ <= tau + duration);
}

void CyclePeaks::on_stretch(const Stretch& stretch) {
    const auto [from, to] = stretch.within(window_);
    double duration = to - from, tau = stretch.tau + from;
    if (!(duration > 0)) return;
    const Flow& flow = stretch.flow;
    const Polynomial base = stretch.forces ? stretch.forces->base : Polynomial{},
                     shift = sum(stretch.shift(), base, -1);
    Oscillation o = from > 0 ? flow.after(stretch.start, from) : stretch.start;
    while (true) {
        const double left = end() - tau, part = std::clamp(left, 0.0, duration),
                     s = tau - stretch.tau;
        peak_ = std::max(peak_, std::abs(o.x + shift.at(s)));
        if (peak_ < least_ && part > 0)
            peak_ = shift.is_zero() ? peak_beyond(peak_, flow, o, part)
                                    : peak_beyond(peak_, flow, stretch.start, shift, s, s + part);
        if (duration < left - step_rounding) return;
        least_ = std::min(least_, peak_);
        peak_ = 0;
        if (part > 0) o = flow.after(o, part);
        tau += part;
        duration -= part;
        ++whole_;
    }
}

void Energy::on_impact(const Impact& i) {
    if (i.tau > window_.to) return;
    const Oscillation after = {i.x, i.x_dot_after, i.sin_theta, i.cos_theta};
    const double y = i.x - i.side * parameters_.b;
    // Rounding can end the stretch before it slightly late. An impact with which the run begins is
    // part of it.
    if (i.tau <= window_.from && window_.from > 0) {
        sum_.setZero();
        duration_ = peak_ = friction_ = work_ = 0;
        at_steps_.clear();
        end_ = {i.x_dot_after, i.x, i.y_dot_after, y};
        start_ = energy_of(parameters_, end_);
        last_ = {after, 0, i.y_dot_after, false, false};
        return;
    }
    if (duration_ == 0) start_ = energy_of(parameters_, {i.x_dot_before, i.x, i.y_dot_before, y});
    const double w = i.relative_speed_before;
    impacts_ += (1 - i.R * i.R) * w * w * parameters_.epsilon / (2 * (1 + parameters_.epsilon));
    end_.x_dot = i.x_dot_after, end_.y_dot = i.y_dot_after;
    if (last_.in_closed_form) sum_ += free_.antiderivative->across(after, i.x_dot_before);
    last_ = {after, 0, i.y_dot_after, false, last_.in_closed_form};
}

EnergyBalance Energy::balance(const Interval& reached) const {
    const Parameters& p = parameters_;
    const Integrals sum = integrals();
    const Oscillation o = end();
    const double input = p.load ? work_ : p.epsilon * p.A() * sum(x_dot_sin),
                 damper = 2 * p.zeta() * sum(x_dot_squared),
                 at_end =
                     p.has_straight_flights()
                         ? energy_of(p, {o.x_dot, o.x, last_.is_stuck ? o.x_dot : last_.y_dot, 0})
                         : energy_of(p, end_),
                 stored = at_end - start_;
    const double total = impacts_ + friction_ + damper, share = impacts_ / total,
                 rms = duration_ > 0 ? std::sqrt(sum(x_squared) / duration_) : 0;
    // The errors of a root and of a ratio follow by the delta method.
    std::vector<double> squares, excess;
    Sums before{};
    for (const Sums& s : at_steps_) {
        squares.push_back(s.x_squared - before.x_squared);
        excess.push_back(
            (1 - share) * (s.impacts - before.impacts) -
            share * (2 * p.zeta() * (s.x_dot_squared - before.x_dot_squared) + s.friction -
                     before.friction));
        before = s;
    }
    const double observed = steps_.duration() * static_cast<double>(at_steps_.size());
    return {
        .window = reached,
        .input = p.is_forced() ? input : 0,
        .damper = damper,
        .impacts = impacts_,
        .friction = friction_,
        .stored = stored,
        .residual = input - damper - impacts_ - friction_ - stored,
        .at_start = start_,
        .at_end = at_end,
        .share_impacts = ratio(impacts_, total),
        .rms = rms,
        .peak = peak_,
        .rms_error = error_of_modulated_sum(squares) / observed / (2 * rms),
        .share_impacts_error =
            error_of_modulated_sum(excess) /
            (before.impacts + before.friction + 2 * p.zeta() * before.x_dot_squared),
        .difference_of_halves = difference_of_halves(squares)};
}

std::optional<double> ratio(double numerator, double denominator) {
    return denominator > 0 ? std::optional(numerator / denominator) : std::nullopt;
}

std::optional<double> free_amplitude(const Parameters& p) {
    const double detuning = (1 - p.Omega) * (1 + p.Omega),
                 D = detuning * detuning + 4 * p.zeta() * p.zeta() * p.Omega * p.Omega;
    if (D == 0) return std::nullopt;
    return p.epsilon * p.A() / std::sqrt(D);
}

std::optional<State> free_steady_state(const Parameters& p) {
    const auto amplitude = free_amplitude(p);
    if (!amplitude) return std::nullopt;
    // At theta = phi: x = C sin(theta - delta), tan(delta) = 2 zeta Omega/(1 - Omega^2).
    const double delta = elementary::atan2(2 * p.zeta() * p.Omega, (1 - p.Omega) * (1 + p.Omega)),
                 theta = p.phi() - delta;
    return State{
        .x_dot = *amplitude * p.Omega * elementary::cos(theta),
        .x = *amplitude * elementary::sin(theta)};
}

Unattached unattached(
    const Parameters& p, const State& start, const Interval& window, const StopRequest& stop) {
    if (p.load) {
        Parameters alone = p;
        alone.gravity = alone.friction = 0;
        alone.b = std::numeric_limits<double>::max();
        Energy energy(alone, window);
        const Outcome outcome = simulate(
            alone, {start.x_dot, start.x, 0, 0},
            {.tau_end = window.to, .max_impacts = std::numeric_limits<long>::max(), .stop = stop},
            {&energy});
        if (outcome.reason == End::stopped) return {nan, nan, std::nullopt};
        const EnergyBalance balance = energy.balance(window);
        return {balance.rms, balance.peak, std::nullopt};
    }
    const auto table = Flow::shared_free(p);
    const Flow& flow = *table;
    const Oscillation o{start.x, start.x_dot, elementary::sin(p.phi()), elementary::cos(p.phi())};
    const Oscillation begin = flow.after(o, window.from);
    const double duration = window.length();
    return {
        duration > 0
            ? std::sqrt(Quadrature::shared(flow)->over(begin, duration)(x_squared) / duration)
            : 0,
        peak_beyond(0, flow, begin, duration), free_amplitude(p)};
}

void Decay::on_stretch(const Stretch& stretch) {
    const double from = tau_start_ - stretch.tau;
    if (from > stretch.duration) return;
    // At rest the oscillator is displaced by the ball's weight.
    const double weight = parameters_.epsilon * std::abs(parameters_.gravity),
                 at_rest = -weight * (0.5 * weight + parameters_.b);
    auto energy_at = [&](double s) { return energy_of(parameters_, stretch.at(s)) - at_rest; };
    if (!at_start_) at_start_ = energy_at(std::max(0.0, from));
    if (*at_start_ == 0) return;  // at rest: no energy to lose
    const double end = energy_at(stretch.duration);
    for (const auto& [time, fraction] : decay_levels) {
        const double level = fraction * *at_start_;
        if (!(times.*time) && end <= level)
            times.*time = std::max(
                tau_start_, crossing_time(energy_at, level, stretch.duration, stretch.tau));
    }
}

DecayTimes unattached_decay(const Parameters& p, const State& start, double tau_start) {
    DecayTimes times;
    const Flow flow(1, 2 * p.zeta(), 0, p.Omega);
    const Oscillation begin = flow.after({start.x, start.x_dot, 0, 1}, tau_start);
    auto energy_at = [&](double s) {
        const Oscillation o = flow.after(begin, s);
        return 0.5 * (o.x * o.x + o.x_dot * o.x_dot);
    };
    if (p.zeta() == 0 || energy_at(0) == 0) return times;
    for (const auto& [time, fraction] : decay_levels) {
        const double level = fraction * energy_at(0);
        double high = 1;
        while (energy_at(high) > level && high < longest_decay) high *= 2;
        if (high < longest_decay) times.*time = crossing_time(energy_at, level, high, tau_start);
    }
    return times;
}

}  // namespace vines
