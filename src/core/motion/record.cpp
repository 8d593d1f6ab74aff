#include "core/motion/record.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

// Longest table: about the number of samples in a flight of a densely sampled run.
constexpr std::size_t longest_table = 64;
// Largest rounding of a sample time that two Taylor terms correct; their error is its square.
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
    // Rounding of tau.
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

void SeriesRecord::expect(double tau_end) {
    const auto samples = static_cast<std::size_t>(std::min(tau_end / step_, 1e6)) + 2;
    for (auto* column : series.columns()) column->reserve(samples);
}

void SeriesRecord::add(double at, const State& state, double acceleration, double base) {
    series.tau.push_back(at);
    series.x.push_back(state.x);
    series.x_dot.push_back(state.x_dot);
    series.y.push_back(state.y);
    series.y_dot.push_back(state.y_dot);
    series.x_ddot.push_back(acceleration);
    if (with_base_) series.x_relative.push_back(state.x - base);
}

void SeriesRecord::on_stretch(const Stretch& stretch) {
    SampledFlow& oscillator = stretch.is_joint() ? sticking_ : free_;
    oscillator.begin(stretch.flow, stretch.start);
    const auto base_at = [&](double s) { return with_base_ ? stretch.forces->base.at(s) : 0.0; };
    for (double at = next_ * step_; at < stretch.tau + stretch.duration; at = ++next_ * step_) {
        const double s = std::max(0.0, at - stretch.tau);
        const Oscillation o = oscillator.at(s);
        add(at, stretch.at(s, o), stretch.x_ddot(s, o), base_at(s));
    }
    x_ddot_at_end_ = stretch.x_ddot(stretch.duration);
    base_at_end_ = base_at(stretch.duration);
}

void SeriesRecord::finish(const Outcome& outcome) {
    if (series.tau.empty() || series.tau.back() < outcome.tau)
        add(outcome.tau, outcome.state, x_ddot_at_end_, base_at_end_);
}

void Stroboscope::on_stretch(const Stretch& stretch) {
    const double end = std::min(stretch.tau + stretch.duration, until_);
    // A sample at the very end of a stretch shows the state before the event there.
    for (double at = tau_of(next_); at <= end; at = tau_of(next_)) {
        const long k = next_++;
        take(k, stretch.at(std::max(0.0, at - stretch.tau)));
    }
}

namespace {

/// Keeps only the first impact of a chatter.
void fold_chatter(std::vector<CountedContact>& contacts, const StickStart& start) {
    if (start.impacts > 1)
        contacts.resize(contacts.size() - static_cast<std::size_t>(start.impacts - 1));
}

// Relative tolerance for the time between two impacts of a chatter: impact times are rounded.
constexpr double bounce_margin = 1e-3;

}  // namespace

void ContactRecord::on_impact(const Impact& impact) {
    ++impacts;
    contacts.push_back({impact.tau, impact.side});
}

void ContactRecord::on_stick(const StickStart& start) {
    sticks.push_back({start.tau, start.tau});
    fold_chatter(contacts, start);
}

// All impacts of a chatter are on one side, its flights at most Run::longest_bounce_ long.
ContactStream::ContactStream(const Parameters& p)
    : longest_bounce_((1 + bounce_margin) * p.faster_half_cycle()) {}

void ContactStream::on_impact(const Impact& impact) {
    if (!held_.empty() &&
        (impact.side != held_.back().side || impact.tau - held_.back().tau > longest_bounce_))
        flush_contacts();
    held_.push_back({impact.tau, impact.side});
}

void ContactStream::on_stick(const StickStart& start) {
    fold_chatter(held_, start);
    flush_contacts();
}

void ContactStream::flush_contacts() {
    for (const CountedContact& contact : held_) on_contact(contact);
    held_.clear();
}

}  // namespace vines
