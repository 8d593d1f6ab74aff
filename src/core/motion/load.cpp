#include "core/motion/load.hpp"

#include <algorithm>
#include <cmath>

namespace vines {

Load::Load(LoadKind kind, const std::vector<double>& tau, const std::vector<double>& values)
    : kind_(kind),
      tau_(tau) {
    long double x = 0, v = 0;  // of the base
    for (std::size_t i = 0; i < tau.size(); ++i) {
        const bool last = i + 1 == tau.size();
        const long double h = last ? 1 : static_cast<long double>(tau[i + 1]) - tau[i],
                          slope =
                              last ? 0 : (static_cast<long double>(values[i + 1]) - values[i]) / h,
                          value = values[i];
        if (kind != LoadKind::base_acceleration) {
            const bool zero = last && kind == LoadKind::force;
            pieces_.push_back({zero ? 0 : values[i], static_cast<double>(slope)});
            largest_ = std::max(largest_, std::abs(values[i]));
            continue;
        }
        largest_ = std::max(largest_, std::abs(static_cast<double>(x)));
        if (last) {
            pieces_.push_back({static_cast<double>(x), static_cast<double>(v)});
            continue;
        }
        pieces_.push_back(
            {static_cast<double>(x), static_cast<double>(v), 0.5 * values[i],
             static_cast<double>(slope / 6)});
        x += h * (v + h * (value / 2 + h * slope / 6));
        v += h * (value + h * slope / 2);
    }
    if (kind == LoadKind::force) largest_ = 0;
}

std::size_t Load::interval_at(double tau) const {
    const auto after = std::ranges::upper_bound(tau_, tau);
    return after == tau_.begin() ? 0 : static_cast<std::size_t>(after - tau_.begin()) - 1;
}

Cubic Load::base(std::size_t interval, double from) const {
    return moves_base() ? pieces_[interval].about(from - tau_[interval]) : Cubic{};
}

Cubic Load::force(std::size_t interval, double from, double damping) const {
    const Cubic c = pieces_[interval].about(from - tau_[interval]);
    if (!moves_base()) return c;
    return {c.c0 + damping * c.c1, c.c1 + 2 * damping * c.c2, c.c2 + 3 * damping * c.c3, c.c3};
}

Cubic particular_solution(const Flow& flow, const Cubic& force) {
    const double k = flow.coefficients()[0], d = flow.damping();
    Cubic p;
    p.c3 = force.c3 / k;
    p.c2 = (force.c2 - 3 * d * p.c3) / k;
    p.c1 = (force.c1 - 2 * d * p.c2 - 6 * p.c3) / k;
    p.c0 = (force.c0 - d * p.c1 - 2 * p.c2) / k;
    return p;
}

}  // namespace vines
