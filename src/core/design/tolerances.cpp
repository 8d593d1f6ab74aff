// Scatter of an absorber and its host: each sample draws their values from distributions.
//
// A sample depends only on the seed and its index, so that samples computed in parts agree bit for
// bit; a value depends on no other distribution.
#include <algorithm>
#include <cmath>

#include "core/design/design.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

constexpr int most_draws = 1000;

/// The values that are set as they are; null for f0 and damping_ratio.
double* member_of(BuiltAbsorber& a, Toleranced what) {
    switch (what) {
        case Toleranced::m1: return &a.si.m1;
        case Toleranced::k1: return &a.si.k1;
        case Toleranced::c1: return &a.si.c1;
        case Toleranced::m2: return &a.si.m2;
        case Toleranced::b: return &a.b;
        case Toleranced::R: return &a.R;
        case Toleranced::amplitude: return &a.amplitude;
        case Toleranced::f0:
        case Toleranced::damping_ratio: break;
    }
    return nullptr;
}

void set(BuiltAbsorber& a, Toleranced what, double value) {
    SiParameters& si = a.si;
    const double omega0 = 2 * std::numbers::pi * value;
    if (double* member = member_of(a, what)) *member = value;
    else if (what == Toleranced::f0) si.k1 = si.m1 * omega0 * omega0;
    else si.c1 = 2 * value * si.m1 * si.omega0();
}

}  // namespace

double value_of(const BuiltAbsorber& absorber, Toleranced what) {
    BuiltAbsorber a = absorber;
    if (const double* member = member_of(a, what)) return *member;
    return what == Toleranced::f0 ? a.si.f0() : a.si.damping_ratio();
}

BuiltAbsorber drawn(
    const std::vector<Tolerance>& tolerances, const BuiltAbsorber& nominal, std::uint64_t seed,
    std::size_t index) {
    BuiltAbsorber built = nominal;
    for (const Tolerance& t : tolerances) {
        RandomSequence random =
            RandomSequence(seed).part(index).part(static_cast<std::uint64_t>(t.what));
        const bool is_R = t.what == Toleranced::R, can_be_0 = is_R || t.what == Toleranced::c1 ||
                                                              t.what == Toleranced::damping_ratio;
        const double least = can_be_0 ? 0 : std::numeric_limits<double>::min(),
                     most = is_R ? 1 : infinity;
        const double unit = t.is_factor ? value_of(nominal, t.what) : 1;
        double value = nan;
        for (int k = 0; k < most_draws && !(value >= least && value <= most); ++k)
            value = unit * (t.is_normal ? t.first + t.second * standard_normal(random)
                                        : uniform(random, t.first, t.second));
        set(built, t.what, std::clamp(value, least, most));
    }
    return built;
}

double quantile(const std::vector<double>& ascending, double probability) {
    if (ascending.empty()) return nan;
    const double at = probability * static_cast<double>(ascending.size() - 1),
                 below = std::floor(at), part = at - below;
    const double low = ascending[static_cast<std::size_t>(below)];
    if (part == 0) return low;
    return low + part * (ascending[static_cast<std::size_t>(below) + 1] - low);
}

}  // namespace vines
