#include "laboratory.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vines::test {

namespace {

/// A wrong k1 means a wrong unit of time.
void rescale_time(Experiment& e, double faster) {
    e.omega0 *= faster;
    e.parameters.Omega /= faster;
    e.parameters.lambda /= faster;
    for (double& tau : e.record.tau) tau *= faster;
    for (double& a : e.record.x_ddot) a /= faster * faster;
    for (Impact& i : e.impacts) i.tau *= faster;
    for (StickingPhase& s : e.sticks) s.start.tau *= faster, s.tau_end *= faster;
}

}  // namespace

TrueMotion motion_after(double settling, double b, double R_plus, double R_minus, double seconds) {
    const SiParameters table_4{4.168, 3.02, 11.47e3, 0.032, 0, 0};
    Parameters p;
    p.epsilon = table_4.epsilon(), p.lambda = table_4.lambda(), p.G = 0.01, p.b = b,
    p.R_plus = R_plus, p.R_minus = R_minus;
    return true_motion(p, table_4.omega0(), settling, seconds);
}

TrueMotion settled_motion(double b, double R_plus, double R_minus, double seconds) {
    // A chaotic motion sticks occasionally: takes the first part without sticking.
    const double step = std::max(10.0, seconds / 10);
    for (int k = 0; k < 60; ++k) {
        TrueMotion motion = motion_after(20 + k * step, b, R_plus, R_minus, seconds);
        if (motion.sticks.empty()) return motion;
    }
    throw std::runtime_error("every part of the motion sticks");
}

Experiment measured(const TrueMotion& motion, const Sensors& sensors, const GivenErrors& given) {
    Experiment e{
        motion.parameters,
        motion.omega0,
        measured_record(motion, sensors),
        motion.impacts,
        motion.sticks,
        motion.exponents.qr()[0],
        motion.parameters,
        long_run_verdict(motion.parameters)};
    e.parameters.Omega *= 1 + given.frequency;
    e.parameters.lambda *= 1 + given.damping;
    rescale_time(e, std::sqrt(1 + given.stiffness));
    return e;
}

std::vector<IdentifiedImpact> listed(const std::vector<Impact>& impacts) {
    std::vector<IdentifiedImpact> list;
    for (const Impact& i : impacts) list.push_back(vines::listed(i));
    return list;
}

Verdict long_run_verdict(const Parameters& p) {
    static std::vector<std::pair<Parameters, Verdict>> known;
    const auto same = [&p](const auto& k) {
        return k.first.b == p.b && k.first.R_plus == p.R_plus && k.first.R_minus == p.R_minus &&
               k.first.G == p.G;
    };
    if (const auto k = std::find_if(known.begin(), known.end(), same); k != known.end())
        return k->second;
    const double begin = 2e4, end = 2e5;
    Lyapunov lyapunov(p, {begin, end}, qr_alone);
    Observer* const observers[] = {&lyapunov};
    simulate(
        p, default_state(p), {.tau_end = end, .max_impacts = std::numeric_limits<long>::max()},
        observers);
    const Verdict verdict =
        lyapunov.product().qr()[0] > 0.004 ? Verdict::chaotic : Verdict::regular;
    known.emplace_back(p, verdict);
    return verdict;
}

Experiment regular_record(
    double R_plus, double R_minus, const Sensors& sensors, const GivenErrors& given) {
    return measured(settled_motion(0.009, R_plus, R_minus, 12), sensors, given);
}

Experiment measured(double b, double R_plus, double R_minus, const Sensors& sensors) {
    return measured(settled_motion(b, R_plus, R_minus, 20), sensors);
}

Measurement measurement_of(const Experiment& e) {
    return {.parameters = e.parameters, .record = e.record};
}

MeasurementResult identified(const Experiment& e) {
    return evaluate_measurement(measurement_of(e));
}

}  // namespace vines::test
