#include "core/motion/sampled_flow.hpp"

#include <cmath>

namespace vines {

namespace {

// A table no longer than what a flight has of samples where they are dense.
constexpr std::size_t longest_table = 64;
// Of a moment that is off by more, the first two terms of the Taylor series would not do: their
// error is the square of it.
constexpr double most_rounding = 1e-9;

}  // namespace

void SampledFlow::begin(const Flow& flow, const Oscillation& start) {
    flow_ = &flow;
    start_ = start;
    origin_.reset();
    if (of_ == flow.coefficients()) return;
    of_ = flow.coefficients();
    table_.clear();
}

SampledFlow::Steps SampledFlow::steps_over(double time) const {
    const Oscillation of_x = flow_->after({1, 0, 0, 0}, time),
                      of_x_dot = flow_->after({0, 1, 0, 0}, time),
                      of_sin = flow_->after({0, 0, 1, 0}, time),
                      of_cos = flow_->after({0, 0, 0, 1}, time);
    return {
        time,
        {of_x.x, of_x_dot.x, of_sin.x, of_cos.x},
        {of_x.x_dot, of_x_dot.x_dot, of_sin.x_dot, of_cos.x_dot},
        of_cos.cos_theta,
        of_cos.sin_theta};
}

Oscillation SampledFlow::at(double s) {
    const std::size_t j = origin_ ? ++origin_->steps : 0;
    const double time = static_cast<double>(j) * step_;
    // tau is rounded, and s with it.
    const double late = origin_ ? s - origin_->s - time : 0;
    if (j == 0 || j > longest_table || time > flow_->reach() || std::abs(late) > most_rounding) {
        origin_ = {s, flow_->after(start_, s), 0};
        return origin_->state;
    }
    if (table_.size() < j) table_.push_back(steps_over(time));
    const Steps& over = table_[j - 1];
    const Oscillation& from = origin_->state;
    const auto sum = [&from](const Oscillation& parts) {
        return parts.x * from.x + parts.x_dot * from.x_dot + parts.sin_theta * from.sin_theta +
               parts.cos_theta * from.cos_theta;
    };
    Oscillation o = {
        sum(over.x), sum(over.x_dot), from.sin_theta * over.cos + from.cos_theta * over.sin,
        from.cos_theta * over.cos - from.sin_theta * over.sin};
    const double Omega = (*of_)[3], x_ddot = flow_->acceleration(o);
    return {
        o.x + o.x_dot * late, o.x_dot + x_ddot * late, o.sin_theta + Omega * o.cos_theta * late,
        o.cos_theta - Omega * o.sin_theta * late};
}

}  // namespace vines
