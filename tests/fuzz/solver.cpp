// Fuzz target: motions of systems that a request can specify, checked against the invariants of
// every motion. The input is a line of numbers: the system and its start in the order of
// parameter_ranges(), with y as a fraction of b, then the damping, tau_end and the time of the
// start.
#include <cmath>

#include "core/analysis/analysis.hpp"
#include "core/motion/contact_search.hpp"
#include "fuzz.hpp"

using namespace vines;
using fuzz::require;

namespace {

constexpr long most_impacts = 1000;
// Calls of a stop function, which occur every 64 events.
constexpr long max_run_calls = 100, max_analysis_calls = 400;

/// Checks momentum, restitution, energy, order and walls.
class Invariants : public Observer {
public:
    explicit Invariants(const Parameters& p, double tau) : p_(p), tau_(tau) {}
    void on_stretch(const Stretch& s) override {
        require(s.duration >= 0, "time does not decrease");
        require(std::abs(s.tau - tau_) <= 1e-12 * (1 + std::abs(tau_)), "stretches are contiguous");
        tau_ = s.tau + s.duration;
        const double rounding =
            64 * position_rounding(s.flow.bounds(s.start, s.duration), std::abs(s.y) + p_.b, p_.b);
        for (int k = 0; k <= 4; ++k) {
            const State at = s.at(s.duration * k / 4);
            const double apart = at.x - at.y;
            require(std::abs(apart) <= p_.b + rounding, "the ball stays in its cavity");
            if (s.sticking_side != 0)
                require(
                    std::abs(apart - s.sticking_side * p_.b) <= rounding, "it sticks to its wall");
        }
    }
    void on_impact(const Impact& i) override {
        const double before = i.x_dot_before - i.y_dot_before, epsilon = p_.epsilon,
                     R = p_.restitution(i.side, std::abs(before)),
                     after = i.x_dot_after - i.y_dot_after,
                     speed = std::abs(i.x_dot_before) + std::abs(i.y_dot_before);
        const double momentum = i.x_dot_after - i.x_dot_before +
                                epsilon * (i.y_dot_after - i.y_dot_before),
                     gain = i.x_dot_after * i.x_dot_after - i.x_dot_before * i.x_dot_before +
                            epsilon *
                                (i.y_dot_after * i.y_dot_after - i.y_dot_before * i.y_dot_before);
        require(i.side * i.relative_speed_before > 0, "the masses meet");
        require(std::abs(momentum) <= 1e-14 * (1 + epsilon) * speed, "momentum is conserved");
        require(
            std::abs(after + R * before) <= 1e-14 * speed,
            "the relative speed is reversed with factor R");
        require(gain <= 1e-13 * (1 + epsilon) * speed * speed, "no energy is gained");
        require(i.tau >= last_, "impact times increase");
        last_ = i.tau;
    }

private:
    const Parameters& p_;
    double tau_, last_ = -infinity;
};

void check_run(const Parameters& p, const State& start, double tau_start, double duration) {
    Invariants invariants(p, tau_start);
    fuzz::CallLimit call_limit(max_run_calls);
    Observer* const observers[] = {&invariants};
    const State s = simulate(
                        p, start,
                        {.tau_end = tau_start + duration,
                         .max_impacts = most_impacts,
                         .stop = [&] { return call_limit.is_over(); },
                         .tau_start = tau_start},
                        observers)
                        .state;
    require(std::isfinite(s.x) && std::isfinite(s.x_dot), "the oscillator's state is finite");
    require(std::isfinite(s.y) && std::isfinite(s.y_dot), "the ball's state is finite");
}

/// Exact sum of the exponents, for a motion without sticking whose four exponents all have a value.
/// A sliding ball adds the logarithms of its slips, which an analysis does not list.
void check_sum_rule(const Parameters& p, const Analysis& a) {
    if (p.friction > 0 || !a.exponents || a.exponents->product.rank() != 4) return;
    const TransferProduct& product = a.exponents->product;
    double sum = 0, logs = 0, magnitude = 0;
    for (const double exponent : product.qr()) sum += exponent, magnitude += std::abs(exponent);
    if (!std::isfinite(sum)) return;
    for (const Impact& i : a.impacts)
        if (i.tau > product.start_tau() && i.tau <= product.end_tau()) logs += std::log(i.R);
    const double T = product.end_tau() - product.start_tau(), rule = -2 * p.zeta() + 2 * logs / T;
    require(
        std::abs(sum - rule) <= 4 * most_residual + 1e-12 * magnitude, "the sum rule of exponents");
}

void check_analysis(const Parameters& p, const State& start, double tau_end) {
    fuzz::CallLimit call_limit(max_analysis_calls);
    const auto is_over = [&] { return call_limit.is_over(); };
    AnalysisRequest w{
        .parameters = p, .start = start, .tau_end = tau_end, .max_impacts = most_impacts / 4};
    w.parts = {.impacts = true, .exponents = true, .energy = true, .regime = true};
    w.estimators = qr_alone;
    check_sum_rule(p, analyse(w, {.run = is_over, .late = is_over}));
}

}  // namespace

void fuzz::solver(std::string_view text) {
    fuzz::Numbers numbers(text);
    Parameters p;
    State start;
    for (const ParameterRange& r : parameter_ranges()) {
        double& to = r.parameter ? p.*r.parameter : start.*r.state;
        to = numbers.next(to, r.minimum, r.maximum);
    }
    start.y = start.x - std::clamp(start.y, -1.0, 1.0) * p.b;
    if (numbers.next(0) != 0) p.damping = Damping::closed_form;
    const double tau_end = numbers.next(100, 1e-6, 1e5), tau_start = numbers.next(0, -1e5, 1e5);
    if (!validate(p, start).empty()) return;

    check_run(p, start, tau_start, tau_end);
    check_analysis(p, start, tau_end);
}
