#include "many_impacts.hpp"

#include <numbers>
#include <random>

#include "core/motion/elementary.hpp"

namespace vines::test {

std::optional<TrueMotion> motion_with_many_impacts(std::uint64_t seed) {
    constexpr double settling = 60, seconds = 12, least = 2.9, most = 8.1, contracting = -0.002;
    std::mt19937_64 engine(seed);
    SiParameters si{4.168, 3.02, 11.47e3, 0, 0, 0};
    si.m2 = uniform(engine, 0.02, 0.09);
    si.f = si.omega0() / (2 * std::numbers::pi) * uniform(engine, 0.98, 1.02);
    si.F = uniform(engine, 0.1e-3, 0.6e-3);
    Parameters p;
    p.epsilon = si.epsilon(), p.lambda = si.lambda(), p.G = si.F / si.epsilon();
    p.Omega = si.f * 2 * std::numbers::pi / si.omega0();
    p.b = uniform(engine, 3e-3, 16e-3);
    p.R_plus = uniform(engine, 0.5, 0.9), p.R_minus = uniform(engine, 0.5, 0.9);
    TrueMotion motion = true_motion(p, si.omega0(), settling, seconds);
    const double per_cycle = static_cast<double>(motion.impacts.size()) / (seconds * si.f);
    if (per_cycle < least || per_cycle > most || !motion.sticks.empty() ||
        !(motion.exponents.qr()[0] < contracting))
        return std::nullopt;
    return motion;
}

Experiment experiment_of(const TrueMotion& motion) {
    return {motion.parameters, motion.omega0,   measured_record(motion, {}),
            motion.impacts,    motion.sticks,   motion.exponents.qr()[0],
            motion.parameters, Verdict::regular};
}

}  // namespace vines::test
