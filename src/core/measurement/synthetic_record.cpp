#include "core/measurement/synthetic_record.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace vines {

namespace {

constexpr double sampling_rate = 2048, pulse_seconds = 0.8e-3;
constexpr std::uint64_t noise_seed = 5;

/// Collects stretches; a long flight is represented by its first one.
class TrueStretches : public Observer {
public:
    void on_impact(const Impact&) override { begins_ = true; }
    void on_release(double) override { begins_ = true; }
    void on_stretch(const Stretch& s) override {
        const bool sticks = s.sticking_side != 0;
        if (begins_ || all.back().sticks != sticks) all.push_back({s.tau, s.start, sticks});
        begins_ = false;
    }
    std::vector<TrueStretch> all;

private:
    bool begins_ = true;
};

/// Adds a half sine at each impact; its integral over tau is the jump of x'.
void add_half_sines(const TrueMotion& motion, MeasuredRecord& r) {
    constexpr double half = 0.5 * pulse_seconds;
    for (const Impact& i : motion.impacts) {
        const double jump = i.x_dot_after - i.x_dot_before;
        for (std::size_t k = first_index(r, i.tau - half * motion.omega0); k < r.tau.size(); ++k) {
            const double t = (r.tau[k] - i.tau) / motion.omega0;
            if (!(r.tau[k] < i.tau + half * motion.omega0)) break;
            const double height = std::abs(t) < half
                                      ? 0.5 * std::numbers::pi / pulse_seconds *
                                            elementary::cos(std::numbers::pi * t / pulse_seconds)
                                      : 0;
            r.x_ddot[k] += jump / motion.omega0 * height;
        }
    }
}

}  // namespace

OscillatorMotion TrueOscillator::at(double tau) const {
    const auto after = std::ranges::upper_bound(
        motion.stretches.begin() + 1, motion.stretches.end(), tau, {}, &TrueStretch::tau);
    const TrueStretch& s = *(after - 1);
    const Flow& flow = s.sticks ? stuck : free;
    const Oscillation o = flow.after(s.start, tau - s.tau);
    return {o.x, o.x_dot, flow.acceleration(o)};
}

TrueMotion true_motion(
    const Parameters& p, double omega0, double settling, double seconds,
    const ExponentOptions& estimators) {
    const double begin = settling * omega0, end = begin + seconds * omega0;
    ImpactRecord impacts;
    StickRecord sticks;
    TrueStretches stretches;
    Lyapunov lyapunov(p, {begin, end}, estimators);
    Observer* const observers[] = {&lyapunov, &impacts, &sticks, &stretches};
    constexpr long all = std::numeric_limits<long>::max();
    simulate(p, default_state(p), {.tau_end = end, .max_impacts = all}, observers);

    std::erase_if(impacts.entries, [&](const Impact& i) { return i.tau <= begin; });
    std::erase_if(sticks.entries, [&](const StickingPhase& s) { return s.tau_end <= begin; });
    const auto first = std::ranges::upper_bound(
        stretches.all.begin() + 1, stretches.all.end(), begin, {}, &TrueStretch::tau);
    stretches.all.erase(stretches.all.begin(), first - 1);
    return {
        p,
        omega0,
        begin,
        seconds,
        std::move(impacts.entries),
        std::move(sticks.entries),
        std::move(stretches.all),
        lyapunov.take()};
}

MeasuredRecord synthetic_record(const TrueMotion& motion, const SensorNoise& noise) {
    const TrueOscillator oscillator{motion};
    const double step = motion.omega0 / sampling_rate,
                 noise_a = noise.noise_a * (1 / (motion.omega0 * motion.omega0));
    const auto samples = static_cast<std::size_t>(motion.seconds * sampling_rate);
    MeasuredRecord r;
    for (std::size_t k = 0; k < samples; ++k) {
        const double tau = motion.begin + static_cast<double>(k) * step;
        r.tau.push_back(tau);
        r.x.push_back(oscillator.at(std::max(tau, oscillator.begin())).x);
        r.x_ddot.push_back(oscillator.at(tau).x_ddot);
    }
    add_half_sines(motion, r);
    std::mt19937_64 engine(noise_seed);
    for (std::size_t k = 0; k < samples; ++k) {
        r.x[k] += noise.noise_x * standard_normal(engine);
        r.x_ddot[k] += noise_a * standard_normal(engine);
    }
    return r;
}

}  // namespace vines
