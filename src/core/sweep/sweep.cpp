#include "core/sweep/sweep.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <mutex>
#include <numbers>
#include <thread>

#include "core/measures/energy.hpp"

namespace vines {

namespace {

/// The last points of a section at impact.
class ImpactSection : public Observer {
public:
    explicit ImpactSection(std::size_t most) : most_(most) {}
    void on_impact(const Impact& i) override {
        if (most_ > 0) {
            if (points_.size() < most_) points_.emplace_back();
            points_[count_ % most_] = {
                i.side,        i.phase(),          i.x, i.x_dot_after, i.x - i.side * b,
                i.y_dot_after, i.tau - tau_before_};
        }
        tau_before_ = i.tau;
        ++count_;
    }
    /// In order of time.
    std::vector<SectionPoint> take() {
        if (points_.size() == most_ && most_ > 0)
            std::rotate(
                points_.begin(), points_.begin() + static_cast<std::ptrdiff_t>(count_ % most_),
                points_.end());
        return std::move(points_);
    }
    double b = 0;

private:
    const std::size_t most_;
    std::size_t count_ = 0;
    double tau_before_ = std::nan("");
    std::vector<SectionPoint> points_;
};

std::vector<SectionPoint> stroboscopic_section(
    const StroboscopicRecord& record, double phi, std::size_t most) {
    std::vector<SectionPoint> points;
    const auto& states = record.states;
    for (std::size_t k = states.size() - std::min(states.size(), most); k < states.size(); ++k)
        points.push_back(
            {0, phi, states[k].x, states[k].x_dot, states[k].y, states[k].y_dot, std::nan("")});
    return points;
}

}  // namespace

PointResult measure(
    const Parameters& p, const State& start, const PointOptions& o,
    const std::function<bool()>& stop) {
    const double tau_end = std::round(o.cycles) * p.cycle(),
                 transient = std::round(o.transient_cycles);
    // From a state at a whole cycle: the phase of the forcing is that of tau = 0 again.
    auto pass = [&](const State& s, double from, double cycles) -> Outcome {
        return simulate(
            p, s,
            {from + cycles * p.cycle(),
             static_cast<long>(std::ceil(cycles)) * transient_impacts_per_cycle, stop, from},
            {});
    };
    PointResult r;
    State begin = start;
    if (transient > 0) {
        r.outcome = pass(start, 0, transient);
        if (r.outcome.reason != End::tau_end) return r;
        begin = r.outcome.state;
    }

    Lyapunov lyapunov(p, 0, tau_end, {true, false, false, 256});
    ContactRecord contacts;
    StroboscopicRecord stroboscopic(p), shifted(p, 0, o.section_phase);
    Energy energy(p, 0, tau_end);
    ImpactSection section(o.section == Section::impact ? o.section_points : 0);
    section.b = p.b;
    std::vector<Observer*> observers = {&lyapunov, &contacts, &stroboscopic, &energy};
    if (o.section == Section::impact) observers.push_back(&section);
    if (o.section == Section::stroboscopic) observers.push_back(&shifted);
    r.outcome = simulate(p, begin, {tau_end, o.max_impacts, stop}, observers);
    r.measured = true;

    const TransferProduct& product = lyapunov.product();
    const Growth growth = growth_of(product);
    r.lambda = product.qr();
    r.standard_error = growth.standard_error;
    r.regime = regime_of(
        p, begin, {contacts, stroboscopic, 0, r.outcome.tau, verdict_by_exponents(growth), stop},
        false);
    // A row of points is kept in memory: of the regime its numbers, not its lists.
    for (auto* list : {&r.regime.moving_tau, &r.regime.moving_z, &r.regime.cycles_with}) *list = {};
    r.regime.stretches = {};
    // Of what the motion ends in: a capture outweighs the transient before it.
    r.verdict = judge(growth, r.regime, 0).verdict;
    if (r.regime.capture && r.verdict != Verdict::none)
        r.verdict = r.regime.type == RegimeType::none ? Verdict::none : Verdict::regular;
    r.x_max = energy.peak();
    r.x_rms = energy.rms();
    r.x_free = free_amplitude(p);
    r.x_rms_ratio = r.x_rms / (r.x_free && *r.x_free > 0 ? *r.x_free / std::numbers::sqrt2
                                                         : unattached_rms(p, begin, r.outcome.tau));
    r.share_impacts = energy.impacts() / (energy.impacts() + energy.damper());
    r.impacts = contacts.impacts;
    r.sticks = static_cast<long>(contacts.sticks.size());
    if (o.section == Section::impact) r.section = section.take();
    if (o.section == Section::stroboscopic)
        r.section = stroboscopic_section(shifted, p.phi() + o.section_phase, o.section_points);

    if (!o.carry) return r;
    // A run that ended within a cycle goes on to the end of it.
    Outcome end = r.outcome;
    if (end.reason == End::max_impacts) {
        const double into = end.tau / p.cycle();
        end = pass(end.state, end.tau, std::ceil(into) - into);
    }
    if (end.reason == End::tau_end) r.at_end = end.state;
    return r;
}

std::vector<NamedStart> default_starts(const Parameters& p) {
    std::vector<NamedStart> starts = {{"middle", {}}, {"wall", default_state(p)}};
    const auto amplitude = free_amplitude(p);
    if (!amplitude || *amplitude == 0) return starts;
    // x = C sin(tau' - delta), tan(delta) = 2 zeta Omega/(1 - Omega^2): the steady motion at theta
    // = phi.
    const double delta = std::atan2(2 * p.zeta() * p.Omega, (1 - p.Omega) * (1 + p.Omega)),
                 theta = p.phi() - delta;
    const double x = *amplitude * std::sin(theta);
    const double x_dot = *amplitude * p.Omega * std::cos(theta);
    starts.push_back({"moving", {x_dot, x, 0, x}});
    if (*amplitude < p.b) starts.push_back({"untouched", {x_dot, x, 0, 0}});
    return starts;
}

bool ends_elsewhere(const PointResult& one, const PointResult& other) {
    const Regime &a = one.regime, &b = other.regime;
    // Without impacts there is one motion.
    if (a.type == RegimeType::none || b.type == RegimeType::none) return a.type != b.type;
    auto apart = [&](double share) {
        return std::abs(one.x_rms - other.x_rms) > share * std::max(one.x_rms, other.x_rms);
    };
    if (a.orbit && b.orbit)
        return a.orbit->cycles != b.orbit->cycles || a.orbit->contacts != b.orbit->contacts ||
               apart(0.01);
    return apart(0.25);
}

State carried(const State& s, const Parameters& from, const Parameters& to) {
    State next = s;
    next.y = s.x + (s.y - s.x) * (to.b / from.b);
    return next;
}

void parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task) {
    std::atomic<std::size_t> next = 0;
    std::exception_ptr failure;
    std::mutex failing;
    const auto work = [&] {
        try {
            for (std::size_t i; (i = next++) < count;) task(i);
        } catch (...) {
            next = count;
            const std::lock_guard lock(failing);
            if (!failure) failure = std::current_exception();
        }
    };
    std::vector<std::thread> others;
    const std::size_t wanted = std::min(count, static_cast<std::size_t>(std::max(threads, 1)));
    for (std::size_t t = 1; t < wanted; ++t) others.emplace_back(work);
    work();
    for (std::thread& t : others) t.join();
    if (failure) std::rethrow_exception(failure);
}

}  // namespace vines
