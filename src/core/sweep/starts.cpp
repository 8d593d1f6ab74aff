#include "core/sweep/starts.hpp"

#include "core/measures/energy.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

std::vector<NamedStart> default_starts(const Parameters& p) {
    std::vector<NamedStart> starts = {{"middle", {}}, {"wall", default_state(p)}};
    const auto amplitude = free_amplitude(p);
    if (!amplitude || *amplitude == 0) return starts;
    // The steady motion at theta = phi: x = C sin(theta - delta),
    // tan(delta) = 2 zeta Omega/(1 - Omega^2).
    const double delta = elementary::atan2(2 * p.zeta() * p.Omega, (1 - p.Omega) * (1 + p.Omega)),
                 theta = p.phi() - delta;
    const double x = *amplitude * elementary::sin(theta);
    const double x_dot = *amplitude * p.Omega * elementary::cos(theta);
    starts.push_back({"moving", {x_dot, x, 0, x}});
    if (*amplitude < p.b) starts.push_back({"untouched", {x_dot, x, 0, 0}});
    return starts;
}

State carried(const State& s, const Parameters& from, const Parameters& to) {
    State next = s;
    next.y = s.x + (s.y - s.x) * (to.b / from.b);
    return next;
}

}  // namespace vines
