#include "core/motion/record.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

namespace {

// Longest table: about the number of samples in a flight of a densely sampled run.
constexpr std::size_t longest_table = 64;
// Largest rounding of a sample time that two Taylor terms correct; their error is its square.
constexpr double most_rounding = 1e-9;

/// Threshold of kappa = |(x'' - y'')/(x'- - y'-)| above which an impact counts as nearly tangent.
/// The condition number of M is about 14 kappa^2 at R = .6: an ulp becomes a relative error of
/// 1e-8.
constexpr double nearly_tangent_ratio = 1800;

// Length of the longest list that the service makes; longer ones are reallocated.
constexpr std::size_t most_reserved = 2000000;

/// Impacts of a chatter are slow as well, but neighbouring motions have them too.
bool is_nearly_tangent(const Impact& i) {
    const double apart = i.x_ddot_before - i.y_ddot_before;
    return !(i.side * apart > 0) &&
           std::abs(apart) > nearly_tangent_ratio * std::abs(i.relative_speed_before);
}

class Repetition : public Observer {
public:
    Repetition(const ImpactRange& range, const std::function<void(const Impact&)>& take)
        : range_(range),
          take_(take) {}
    void on_impact(const Impact& impact) override {
        const long number = seen_++ - range_.first;
        if (number >= 0 && number < range_.count) take_(impact);
    }
    bool complete() const { return seen_ >= range_.first + range_.count; }

private:
    const ImpactRange range_;
    const std::function<void(const Impact&)>& take_;
    long seen_ = 0;
};

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

void Stroboscope::on_stretch(const Stretch& stretch) {
    const double end = std::min(stretch.tau + stretch.duration, until_);
    // A sample at the very end of a stretch shows the state before the event there.
    for (double at = tau_of(next_); at <= end; at = tau_of(next_)) {
        const long k = next_++;
        take(k, stretch.at(std::max(0.0, at - stretch.tau)));
    }
}

void ContactStream::on_impact(const Impact& impact) {
    if (!held_.empty() &&
        (impact.side != held_.back().side || impact.tau - held_.back().tau > longest_bounce_))
        flush_contacts();
    held_.push_back({impact.tau, impact.side});
}

void ContactStream::flush_contacts() {
    for (const ContactEvent& contact : held_) on_contact(contact);
    held_.clear();
}

ImpactCollector::ImpactCollector(std::size_t most_listed, std::size_t most_kept)
    : most_listed_(most_listed),
      most_kept_(most_kept),
      speeds_(most_listed) {}

void ImpactCollector::on_impact(const Impact& impact) {
    if (!kept_) return conclude(seen_++, impact);
    ++seen_;
    entries.push_back(impact);
    keep_last(entries, most_listed_);
    if (std::min(entries.size(), most_listed_) <= most_kept_) return;
    kept_ = false;
    // Reserved: reallocation would cost half as much time again. Unwritten memory takes no RAM.
    speeds_.entries.reserve(std::min(most_listed_, most_reserved));
    for (std::size_t k = 0; k < entries.size(); ++k) conclude(static_cast<long>(k), entries[k]);
    entries = {};
}

void ImpactCollector::conclude(long number, const Impact& impact) {
    const double speed = std::abs(impact.relative_speed_before);
    speeds_.add(speed);
    if (is_nearly_tangent(impact)) nearly_tangent.push_back({number, impact.tau, speed});
}

void ImpactCollector::finish() {
    trim_to_last(entries, most_listed_);
    const long first = listed().first;
    for (std::size_t k = 0; k < entries.size(); ++k)
        conclude(first + static_cast<long>(k), entries[k]);
    std::erase_if(nearly_tangent, [first](const NearlyTangent& n) { return n.number < first; });
    trim_to_last(speeds_.entries, most_listed_);
    std::vector<double> speeds = std::move(speeds_.entries);
    if (speeds.empty()) return;
    const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
    std::nth_element(speeds.begin(), middle, speeds.end());
    typical_speed = *middle;
}

ImpactRange ImpactCollector::listed() const {
    const auto seen = static_cast<std::size_t>(seen_), count = std::min(seen, most_listed_);
    return {static_cast<long>(seen - count), static_cast<long>(count)};
}

bool repeat_impacts(
    const Parameters& p, const State& start, const Limits& limits, const ImpactRange& range,
    const std::function<void(const Impact&)>& take) {
    Repetition repetition(range, take);
    Limits until = limits;
    until.stop = [&] { return repetition.complete() || (limits.stop && limits.stop()); };
    simulate(p, start, until, {&repetition});
    return repetition.complete();
}

}  // namespace vines
