#include "core/analysis/perturbation.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "core/stability/lyapunov.hpp"

namespace vines {

namespace {

/// Bounds a long chatter in the cycle after the end; later impacts change nothing.
constexpr long most_ahead = 1000;
/// Vectors this close to the centre of the unit ball are drawn again: few of their bits are random.
constexpr double least_drawn = 1e-3;

/// J(s) d, eq. (18); also in sticking phases, for the centre of mass.
Eigen::Vector4d carried_over(
    const Flow& flow, bool sticking, double s, double epsilon, Eigen::Vector4d d) {
    carry(d, {flow.transfer(s), s, 0, 1, sticking}, epsilon);
    return d;
}

/// Interval in which one run has had a contact that the other has not had yet.
struct ContactGap {
    double from, to;
    /// Null while one run settles into sticking, where the plain difference is used.
    const ComparedContact* impact;
    bool of_reference;  ///< the impact is the reference's
};

class ContactPairing {
public:
    using Contacts = std::vector<ComparedContact>;

    /// `end` of the comparison. Contacts after it are known for both runs.
    ContactPairing(const Contacts& reference, const Contacts& second, double end)
        : contacts_{&reference, &second},
          end_(end) {
        while (!parted && has(0) && has(1)) {
            if (at(0).stick || at(1).stick) settle();
            else pair();
        }
        for (const int run : {0, 1})
            while (!parted && has(run)) {
                if (!at(run).stick) separate(at(run).tau);
                ++next_[run];
            }
    }

    std::vector<ContactGap> gaps;  ///< ascending in both ends
    std::optional<double> parted;  ///< within the comparison

private:
    bool has(int run) const { return next_[run] < contacts_[run]->size(); }
    const ComparedContact& at(int run) const { return (*contacts_[run])[next_[run]]; }

    void separate(double tau) {
        // A mismatch after the end does not separate the runs before it, but ends the pairing.
        if (!parted && tau <= end_) parted = tau;
        next_[0] = contacts_[0]->size(), next_[1] = contacts_[1]->size();
    }

    void pair() {
        const int first = at(0).tau <= at(1).tau ? 0 : 1, later = 1 - first;
        if (!correspond(first, later)) return separate(at(first).tau);
        gaps.push_back({at(first).tau, at(later).tau, &at(first), first == 0});
        ++next_[0], ++next_[1];
    }

    /// True if both are on one side and the later one is nearer to the first than to the impact
    /// that follows the first. In a chatter, where alone the wall presses, the order decides.
    bool correspond(int first, int later) const {
        if (at(first).side != at(later).side) return false;
        if (next_[first] + 1 == contacts_[first]->size()) return true;
        const ComparedContact& following = (*contacts_[first])[next_[first] + 1];
        if (at(first).pressed && following.side == at(first).side) return true;
        return at(later).tau - at(first).tau <= std::abs(following.tau - at(later).tau);
    }

    /// One run sticks. The other sticks too, after the rest of its chatter; or it does not, since
    /// the wall no longer presses: then the sticking phase is short and does not separate the runs.
    void settle() {
        const int sticking = at(0).stick ? 0 : 1, other = 1 - sticking;
        const ComparedContact& stick = at(sticking);
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
        gaps.push_back({from, to, nullptr, false});
        ++next_[sticking];
    }

    const Contacts* const contacts_[2];
    const double end_;
    std::size_t next_[2] = {0, 0};
};

/// State of a run continued as if impact `c` had not happened.
State continued(const Parameters& p, const Flow& flow, const ComparedContact& c, double tau) {
    const double s = tau - c.tau;
    const Oscillation o = flow.after(c.before, s);
    return {o.x_dot, o.x, c.y_dot_before, c.before.x - c.side * p.b + c.y_dot_before * s};
}

State state_at(const Series& s, std::size_t i) { return {s.x_dot[i], s.x[i], s.y_dot[i], s.y[i]}; }

/// Writes distances and tangent lengths into `result`. Returns true at comparable samples.
std::vector<char> measure_distances(
    const Parameters& p, const ComparedRun& reference, const std::vector<ContactGap>& gaps,
    Perturbation& result) {
    const auto flow = Flow::shared_free(p);
    std::vector<char> comparable;
    auto gap = gaps.begin();
    for (std::size_t i = 0; i < result.series.tau.size(); ++i) {
        const double tau = result.series.tau[i];
        State own = state_at(reference.series(), i), other = state_at(result.series, i);
        double tangent = reference.tangent[i];
        const bool together = !result.parted || tau < *result.parted;
        while (gap != gaps.end() && gap->to <= tau) ++gap;
        const bool in_gap = together && gap != gaps.end() && gap->from <= tau;
        const ComparedContact* const impact = in_gap ? gap->impact : nullptr;
        if (impact) (gap->of_reference ? own : other) = continued(p, *flow, *impact, tau);
        if (impact && gap->of_reference)
            tangent = carried_over(
                          *flow, false, tau - impact->tau, p.epsilon, vector_of(impact->deviation))
                          .norm();
        result.distance.push_back(length_of(difference_of(other, own)));
        result.tangent.push_back(tangent);
        comparable.push_back(together && (!in_gap || impact));
    }
    return comparable;
}

/// Least-squares slope through points (x, y); NaN if they define none.
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

/// lambda1 by qr from the first to the last impact in `tau`.
double lambda1_over(
    const Parameters& p, const State& start, const Interval& tau, const Limits& limits) {
    Lyapunov lyapunov(p, tau, qr_alone);
    Limits until = limits;
    until.tau_end = tau.to;
    const Outcome outcome = simulate(p, start, until, {&lyapunov});
    return outcome.reason == End::stopped ? nan : lyapunov.product().qr()[0];
}

/// Finds the interval in which the distance agrees with the linear theory, and its growth.
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
        if (!(r.distance[end] > 0 && off <= linear_share * r.tangent[end])) break;
        r.linear_until = tau[end];
    }
    double first_impact = nan;
    for (const ComparedContact& c : contacts) {
        if (c.stick || c.tau > r.linear_until) continue;
        if (r.linear_impacts++ == 0) first_impact = c.tau;
    }
    if (r.linear_impacts < fewest_linear_impacts) return;
    std::vector<double> times, log_distances;
    for (std::size_t i = 0; i < end; ++i)
        if (comparable[i] && tau[i] >= first_impact) {
            times.push_back(tau[i]);
            log_distances.push_back(elementary::log(r.distance[i]));
        }
    if (times.size() < 2) return;
    const Interval stretch{first_impact, r.linear_until};
    r.linear = {
        stretch, slope_through(times, log_distances), lambda1_over(p, start, stretch, limits)};
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

double length_of(const State& d) {
    return std::sqrt(d.x_dot * d.x_dot + d.x * d.x + d.y_dot * d.y_dot + d.y * d.y);
}

void ComparedRun::on_stretch(const Stretch& stretch) {
    const auto deviation_after = [&](double s) {
        return carried_over(
            stretch.flow, stretch.sticking_side != 0, s, parameters_.epsilon, deviation_);
    };
    if (step_ > 0) series_.on_stretch(stretch);
    for (std::size_t i = tangent.size(); i < series().tau.size(); ++i)
        tangent.push_back(deviation_after(std::max(0.0, series().tau[i] - stretch.tau)).norm());
    deviation_ = deviation_after(stretch.duration);
}

void ComparedRun::on_impact(const Impact& i) {
    add(
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

double ComparedRun::look_ahead(const Outcome& outcome) {
    if (is_cut_) return contacts.end()[-most_ahead].tau;
    ComparedRun ahead(parameters_, 0, {});
    simulate(
        parameters_, outcome.state,
        {.tau_end = outcome.tau + parameters_.cycle(),
         .max_impacts = most_ahead,
         .tau_start = outcome.tau},
        {&ahead});
    auto from = ahead.contacts.begin();
    // A sticking phase that spans the end is recorded by both runs.
    const bool sticking =
        !contacts.empty() && contacts.back().stick && contacts.back().release >= outcome.tau;
    if (sticking && from != ahead.contacts.end() && from->stick && from->tau <= outcome.tau) {
        contacts.back().release = from->release;
        ++from;
    }
    contacts.insert(contacts.end(), from, ahead.contacts.end());
    return outcome.tau;
}

Perturbation perturbation_of(
    const Parameters& p, const State& start, const State& difference, ComparedRun& reference,
    const Outcome& outcome, Limits limits, double step) {
    const State perturbed = displaced(start, difference);
    ComparedRun second(p, step, {});
    limits.tau_end = reference.look_ahead(outcome);
    limits.max_impacts = std::min(limits.max_impacts, static_cast<long>(most_compared / 2));
    Perturbation r{};
    r.start = difference_of(perturbed, start);
    r.outcome = outcome.tau > 0 ? simulate(p, perturbed, limits, {&second})
                                : Outcome{outcome.reason, outcome.tau, perturbed, 0};
    // A run that ended early has no sample at its end, unless it is empty otherwise.
    if (r.outcome.tau == outcome.tau || second.series().tau.empty()) second.finish(r.outcome);
    for (const ComparedContact& c : second.contacts)
        if (!c.stick) r.impacts.push_back({c.tau, c.side});
    second.look_ahead(r.outcome);
    r.series = second.take_series();
    // Cut to the times that it shares with the reference: rounding can shift the last one.
    const auto common = std::ranges::mismatch(r.series.tau, reference.series().tau);
    const auto size = static_cast<std::size_t>(common.in1 - r.series.tau.begin());
    for (auto* column : r.series.columns()) column->resize(size);
    const ContactPairing both(reference.contacts, second.contacts, r.outcome.tau);
    r.parted = both.parted;
    const std::vector<char> comparable = measure_distances(p, reference, both.gaps, r);
    find_linear_stretch(p, start, reference.contacts, comparable, limits, r);
    return r;
}

}  // namespace vines
