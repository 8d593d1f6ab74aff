#include "core/analysis/perturbation.hpp"

#include <algorithm>
#include <cmath>

#include "core/motion/elementary.hpp"
#include "core/motion/random.hpp"
#include "core/motion/special_values.hpp"
#include "core/stability/lyapunov.hpp"

namespace vines {

namespace {

/// A chatter in the cycle behind the end may be long; nothing rests on more of it.
constexpr long most_ahead = 1000;
/// Directions nearer to the middle of the ball that they are drawn from are drawn anew: there few
/// of the numbers' bits are left.
constexpr double least_drawn = 1e-3;

Eigen::Vector4d vector_of(const State& s) { return {s.x_dot, s.x, s.y_dot, s.y}; }

State state_of(const Eigen::Vector4d& v) { return {v(0), v(1), v(2), v(3)}; }

/// J(s) d (18).
Eigen::Vector4d carried_free(const Flow& flow, double s, double epsilon, Eigen::Vector4d d) {
    carry(d, {flow.transfer(s), s, 0, 1, false}, epsilon);
    return d;
}
/// The same; where stuck, of the centre of mass.
Eigen::Vector4d carried_over(const Stretch& stretch, double s, double epsilon, Eigen::Vector4d d) {
    carry(d, {stretch.flow.transfer(s), s, 0, 1, stretch.stuck_side != 0}, epsilon);
    return d;
}

}  // namespace

State random_difference(std::uint64_t seed, double size) {
    std::mt19937_64 engine(seed);
    for (;;) {
        State s;
        for (double* v : {&s.x_dot, &s.x, &s.y_dot, &s.y}) *v = uniform(engine, -1, 1);
        const double length = length_of(s);
        if (length > 1 || length < least_drawn) continue;
        for (double* v : {&s.x_dot, &s.x, &s.y_dot, &s.y}) *v *= size / length;
        return s;
    }
}

State displaced(const State& s, const State& d) {
    return {s.x_dot + d.x_dot, s.x + d.x, s.y_dot + d.y_dot, s.y + d.y};
}
State difference_of(const State& to, const State& from) {
    return {to.x_dot - from.x_dot, to.x - from.x, to.y_dot - from.y_dot, to.y - from.y};
}
double length_of(const State& d) {
    return std::sqrt(d.x_dot * d.x_dot + d.x * d.x + d.y_dot * d.y_dot + d.y * d.y);
}

ComparedContacts::ComparedContacts(const Parameters& p, const State& deviation)
    : parameters_(p),
      deviation_(vector_of(deviation)) {}

void ComparedContacts::on_stretch(const Stretch& stretch) {
    deviation_ = carried_over(stretch, stretch.duration, parameters_.epsilon, deviation_);
}

void ComparedRun::on_stretch(const Stretch& stretch) {
    series_.on_stretch(stretch);
    for (std::size_t i = tangent.size(); i < series().tau.size(); ++i) {
        const double s = std::max(0.0, series().tau[i] - stretch.tau);
        tangent.push_back(carried_over(stretch, s, parameters_.epsilon, deviation_).norm());
    }
    ComparedContacts::on_stretch(stretch);
}

void ComparedContacts::on_impact(const Impact& i) {
    contacts.push_back(
        {.tau = i.tau,
         .side = i.side,
         .stick = false,
         .pressed = i.side * i.x_ddot_before > 0,
         .release = i.tau,
         .before = {i.x, i.x_dot_before, i.sin_theta, i.cos_theta},
         .y_dot_before = i.y_dot_before,
         .deviation = state_of(deviation_)});
    deviation_ = saltation(parameters_, i).times(deviation_);  // (26)
}

void ComparedContacts::on_stick(const StickStart& start) {
    contacts.push_back(
        {.tau = start.tau,
         .side = start.side,
         .stick = true,
         .pressed = true,
         .release = start.tau,
         .before = {},
         .y_dot_before = 0,
         .deviation = {}});
}

void ComparedRun::finish(const Outcome& outcome) {
    series_.finish(outcome);
    if (tangent.size() < series().tau.size()) tangent.push_back(deviation_.norm());
}

void ComparedRun::look_ahead(const Outcome& outcome) {
    ComparedContacts ahead(parameters_, {});
    Observer* const observers[] = {&ahead};
    simulate(
        parameters_, outcome.state,
        {.tau_end = outcome.tau + parameters_.cycle(),
         .max_impacts = most_ahead,
         .tau_start = outcome.tau},
        observers);
    auto from = ahead.contacts.begin();
    // A stick that reaches over the end is told twice.
    const bool stuck =
        !contacts.empty() && contacts.back().stick && contacts.back().release >= outcome.tau;
    if (stuck && from != ahead.contacts.end() && from->stick && from->tau <= outcome.tau) {
        contacts.back().release = from->release;
        ++from;
    }
    contacts.insert(contacts.end(), from, ahead.contacts.end());
}

namespace {

/// A time in which one run has had a contact that the other has not.
struct Lag {
    double from, to;
    /// The impact that one has had; none where one of them comes to a stick, and the plain
    /// difference is taken.
    const ComparedContact* impact;
    bool of_reference;  ///< whether it is the reference's
};

/// Which contacts of two runs belong together.
class Correspondence {
public:
    using Contacts = std::vector<ComparedContact>;

    /// `end`: of what is compared. Contacts behind it are known of both.
    Correspondence(const Contacts& reference, const Contacts& second, double end)
        : contacts_{&reference, &second},
          end_(end) {
        while (!parted && has(0) && has(1)) {
            if (at(0).stick || at(1).stick) settle();
            else pair();
        }
        for (const int run : {0, 1})
            while (!parted && has(run)) {
                if (!at(run).stick) part(at(run).tau);
                ++next_[run];
            }
    }

    std::vector<Lag> lags;         ///< both ends ascend
    std::optional<double> parted;  ///< up to the end

private:
    bool has(int run) const { return next_[run] < contacts_[run]->size(); }
    const ComparedContact& at(int run) const { return (*contacts_[run])[next_[run]]; }

    void part(double tau) {
        // What is behind the end parts nothing before it, and ends the comparison all the same.
        if (!parted && tau <= end_) parted = tau;
        next_[0] = contacts_[0]->size(), next_[1] = contacts_[1]->size();
    }

    void pair() {
        const int first = at(0).tau <= at(1).tau ? 0 : 1, later = 1 - first;
        if (!correspond(first, later)) return part(at(first).tau);
        lags.push_back({at(first).tau, at(later).tau, &at(first), first == 0});
        ++next_[0], ++next_[1];
    }

    /// On one side, and the later one nearer to the first than to what follows the first: else it
    /// is that one which it belongs to. In a chatter one run may be several impacts ahead; only
    /// there the next impact on the same side can be near, for where the wall does not press the
    /// mass leaves it for a part of a cycle.
    bool correspond(int first, int later) const {
        if (at(first).side != at(later).side) return false;
        if (next_[first] + 1 == contacts_[first]->size()) return true;
        const ComparedContact& following = (*contacts_[first])[next_[first] + 1];
        if (at(first).pressed && following.side == at(first).side) return true;
        return at(later).tau - at(first).tau <= std::abs(following.tau - at(later).tau);
    }

    /// One run sticks, and the other one does, too, once what it has left of the chatter is over;
    /// or it does not, for the wall has stopped to press it: then the stick is short and parts
    /// nothing.
    void settle() {
        const int stuck = at(0).stick ? 0 : 1, other = 1 - stuck;
        const ComparedContact& stick = at(stuck);
        double from = stick.tau, to = stick.release;
        const auto belongs = [&] { return has(other) && at(other).side == stick.side; };
        for (; belongs() && !at(other).stick && at(other).pressed && at(other).tau < stick.release;
             ++next_[other])
            from = std::min(from, at(other).tau);
        if (belongs() && at(other).stick) {
            from = std::min(from, at(other).tau);
            to = std::max(stick.tau, at(other).tau);
            ++next_[other];
        }
        lags.push_back({from, to, nullptr, false});
        ++next_[stuck];
    }

    const Contacts* const contacts_[2];
    const double end_;
    std::size_t next_[2] = {0, 0};
};

/// An impact's run, continued as if it had not struck.
State continued(const Parameters& p, const Flow& flow, const ComparedContact& c, double tau) {
    const double s = tau - c.tau;
    const Oscillation o = flow.after(c.before, s);
    return {o.x_dot, o.x, c.y_dot_before, c.before.x - c.side * p.b + c.y_dot_before * s};
}

State state_at(const Series& s, std::size_t i) { return {s.x_dot[i], s.x[i], s.y_dot[i], s.y[i]}; }

/// Distances and lengths of the tangent vector into `result`; true at the moments at which the two
/// may be held against each other.
std::vector<char> measure_distances(
    const Parameters& p, const ComparedRun& reference, const std::vector<Lag>& lags,
    Perturbation& result) {
    const auto flow = Flow::shared_free(p);
    std::vector<char> comparable;
    auto lag = lags.begin();
    for (std::size_t i = 0; i < result.series.tau.size(); ++i) {
        const double tau = result.series.tau[i];
        State own = state_at(reference.series(), i), other = state_at(result.series, i);
        double tangent = reference.tangent[i];
        const bool together = !result.parted || tau < *result.parted;
        bool settling = false;
        while (lag != lags.end() && lag->to <= tau) ++lag;
        if (together && lag != lags.end() && lag->from <= tau) {
            settling = lag->impact == nullptr;
            if (lag->impact) {
                (lag->of_reference ? own : other) = continued(p, *flow, *lag->impact, tau);
                if (lag->of_reference)
                    tangent = carried_free(
                                  *flow, tau - lag->impact->tau, p.epsilon,
                                  vector_of(lag->impact->deviation))
                                  .norm();
            }
        }
        result.distance.push_back(length_of(difference_of(other, own)));
        result.tangent.push_back(tangent);
        comparable.push_back(together && !settling);
    }
    return comparable;
}

/// The slope of the line through points (x, y), by least squares; NaN where they make none.
double slope_through(const std::vector<double>& x, const std::vector<double>& y) {
    const double n = static_cast<double>(x.size());
    double mean_x = 0, mean_y = 0, products = 0, squares = 0;
    for (std::size_t i = 0; i < x.size(); ++i) mean_x += x[i] / n, mean_y += y[i] / n;
    for (std::size_t i = 0; i < x.size(); ++i) {
        products += (x[i] - mean_x) * (y[i] - mean_y);
        squares += (x[i] - mean_x) * (x[i] - mean_x);
    }
    return products / squares;
}

/// qr from the first impact to the last of an interval.
double lambda1_over(
    const Parameters& p, const State& start, const Interval& tau, const Limits& limits) {
    Lyapunov lyapunov(p, tau.from, tau.to, qr_alone);
    Observer* const observers[] = {&lyapunov};
    Limits until = limits;
    until.tau_end = tau.to;
    const Outcome outcome = simulate(p, start, until, observers);
    return outcome.reason == End::stopped ? nan : lyapunov.product().qr()[0];
}

/// Where the distance agrees with the linear theory, from the start on, and how it grows there.
void find_linear_stretch(
    const Parameters& p, const State& start, const std::vector<ComparedContact>& contacts,
    const std::vector<char>& comparable, const Limits& limits, Perturbation& r) {
    const auto parted = [&](double tau) { return r.parted && tau >= *r.parted; };
    const std::vector<double>& tau = r.series.tau;
    std::size_t end = 0;
    r.linear_until = 0;
    for (; end < tau.size() && !parted(tau[end]); ++end) {
        if (!comparable[end]) continue;
        const double off = std::abs(r.distance[end] - r.tangent[end]);
        if (!(r.distance[end] > 0 && off <= vines::linear_share * r.tangent[end])) break;
        r.linear_until = tau[end];
    }
    double first_impact = nan;
    for (const ComparedContact& c : contacts) {
        if (c.stick || c.tau > r.linear_until) continue;
        if (r.linear_impacts++ == 0) first_impact = c.tau;
    }
    if (r.linear_impacts < fewest_linear_impacts) return;
    std::vector<double> moments, logs;
    for (std::size_t i = 0; i < end; ++i)
        if (comparable[i] && tau[i] >= first_impact) {
            moments.push_back(tau[i]);
            logs.push_back(elementary::log(r.distance[i]));
        }
    const Interval stretch{first_impact, r.linear_until};
    r.linear = {stretch, slope_through(moments, logs), lambda1_over(p, start, stretch, limits)};
}

/// Cuts a series down to its moments that the reference has, too: rounding may move the last.
void keep_common(Series& s, const Series& reference) {
    const auto common =
        std::mismatch(s.tau.begin(), s.tau.end(), reference.tau.begin(), reference.tau.end());
    const auto size = static_cast<std::size_t>(common.first - s.tau.begin());
    for (auto* column : {&s.tau, &s.x, &s.x_dot, &s.y, &s.y_dot, &s.x_ddot}) column->resize(size);
}

}  // namespace

Perturbation perturbation_of(
    const Parameters& p, const State& start, const State& difference, ComparedRun& reference,
    const Outcome& outcome, Limits limits, double step) {
    const State beside = displaced(start, difference);
    ComparedRun second(p, step, {});
    Observer* const observers[] = {&second};
    limits.tau_end = outcome.tau;
    Perturbation r{};
    r.start = difference_of(beside, start);
    r.outcome = outcome.tau > 0 ? simulate(p, beside, limits, observers)
                                : Outcome{outcome.reason, outcome.tau, beside, 0};
    // One that ended before has no sample at its end, but where it has come nowhere.
    if (r.outcome.tau == outcome.tau || second.series().tau.empty()) second.finish(r.outcome);
    for (const ComparedContact& c : second.contacts)
        if (!c.stick) r.impacts.push_back({c.tau, c.side});
    reference.look_ahead(outcome);
    second.look_ahead(r.outcome);
    r.series = second.take_series();
    keep_common(r.series, reference.series());
    const Correspondence both(reference.contacts, second.contacts, r.outcome.tau);
    r.parted = both.parted;
    const std::vector<char> comparable = measure_distances(p, reference, both.lags, r);
    find_linear_stretch(p, start, reference.contacts, comparable, limits, r);
    return r;
}

}  // namespace vines
