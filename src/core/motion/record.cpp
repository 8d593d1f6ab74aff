#include "core/motion/record.hpp"

#include <algorithm>

namespace vines {

namespace {

constexpr double most_expected = 1e6;

/// Both masses at the time s of a stretch, where the oscillator's state is known.
State with_mass(const Stretch& stretch, const Oscillation& o, double s) {
    if (stretch.stuck_side != 0)
        return {o.x_dot, o.x, o.x_dot, o.x + (stretch.y - stretch.start.x)};
    return {o.x_dot, o.x, stretch.y_dot, stretch.y + stretch.y_dot * s};
}

}  // namespace

void SeriesRecord::expect(double tau_end) {
    const auto moments = static_cast<std::size_t>(std::min(tau_end / step_, most_expected)) + 2;
    for (auto* column :
         {&series.tau, &series.x, &series.x_dot, &series.y, &series.y_dot, &series.x_ddot})
        column->reserve(moments);
}

void SeriesRecord::add(double at, const State& state, double acceleration) {
    series.tau.push_back(at);
    series.x.push_back(state.x);
    series.x_dot.push_back(state.x_dot);
    series.y.push_back(state.y);
    series.y_dot.push_back(state.y_dot);
    series.x_ddot.push_back(acceleration);
}

void SeriesRecord::on_stretch(const Stretch& stretch) {
    SampledFlow& oscillator = stretch.stuck_side == 0 ? free_ : stuck_;
    oscillator.begin(stretch.flow, stretch.start);
    for (double at = next_ * step_; at < stretch.tau + stretch.duration; at = ++next_ * step_) {
        const double s = std::max(0.0, at - stretch.tau);
        const Oscillation o = oscillator.at(s);
        add(at, with_mass(stretch, o, s), stretch.flow.acceleration(o));
    }
    x_ddot_at_end_ = stretch.x_ddot(stretch.duration);
}

void SeriesRecord::finish(const Outcome& outcome) {
    if (series.tau.empty() || series.tau.back() < outcome.tau)
        add(outcome.tau, outcome.state, x_ddot_at_end_);
}

void Stroboscope::on_stretch(const Stretch& stretch) {
    const double end = std::min(stretch.tau + stretch.duration, until_);
    // One at the very end of a stretch is taken before whatever happens there.
    for (double at = tau_of(next_); at <= end; at = tau_of(next_)) {
        const long k = next_++;
        take(k, stretch.at(std::max(0.0, at - stretch.tau)));
    }
}

}  // namespace vines
