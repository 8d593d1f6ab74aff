#include "core/motion/parameters.hpp"

#include <algorithm>
#include <cstdio>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// Above this damping ratio the cells of the contact search (flow.cpp) are too short.
constexpr double zeta_maximum = 10;

constexpr ParameterRange ranges[] = {
    {"epsilon", &Parameters::epsilon, nullptr, 1e-9, 10},
    {"lambda", &Parameters::lambda, nullptr, 0, 1e9},
    {"G", &Parameters::G, nullptr, 0, 1e3},
    {"Omega", &Parameters::Omega, nullptr, 1e-3, 100},
    {"R_plus", &Parameters::R_plus, nullptr, 0, 1},
    {"R_minus", &Parameters::R_minus, nullptr, 0, 1},
    {"b", &Parameters::b, nullptr, 1e-9, 1e3},
    {"gravity", &Parameters::gravity, nullptr, -1e3, 1e3},
    {"friction", &Parameters::friction, nullptr, 0, 1e3},
    {"x0", nullptr, &State::x, -1e3, 1e3},
    {"x_dot0", nullptr, &State::x_dot, -1e3, 1e3},
    {"y0", nullptr, &State::y, -2e3, 2e3},
    {"y_dot0", nullptr, &State::y_dot, -1e3, 1e3},
};

std::string format(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", value);
    return text;
}

}  // namespace

double RestitutionTable::at(double w) const {
    const auto after = std::ranges::upper_bound(speed, w);
    if (after == speed.begin()) return R.front();
    if (after == speed.end()) return R.back();
    const auto k = static_cast<std::size_t>(after - speed.begin());
    return R[k - 1] + (R[k] - R[k - 1]) * (w - speed[k - 1]) / (speed[k] - speed[k - 1]);
}

double RestitutionTable::derivative(double w) const {
    const auto after = std::ranges::upper_bound(speed, w);
    if (after == speed.begin() || after == speed.end()) return at(w);
    const auto k = static_cast<std::size_t>(after - speed.begin());
    return at(w) + w * (R[k] - R[k - 1]) / (speed[k] - speed[k - 1]);
}

bool Parameters::has_equal_walls() const {
    const auto equal = [](const auto& one, const auto& other) {
        return one == other || (one && other && *one == *other);
    };
    return R_plus == R_minus && equal(table_plus, table_minus);
}

SiParameters in_si(const Parameters& p, double m1, double k1) {
    SiParameters si{m1, 0, k1, p.epsilon * m1, p.G * p.epsilon, 0};
    si.c1 = p.lambda * si.m2 * si.omega0();
    si.f = p.Omega * si.f0();
    return si;
}

// Eq. (3): the base moves spring and damper.
double Parameters::A() const { return G * elementary::hypot(1.0, lambda * epsilon * Omega); }

double Parameters::phi() const { return elementary::atan(lambda * epsilon * Omega); }

std::span<const ParameterRange> parameter_ranges() { return ranges; }

bool is_physical(const Parameters& p) {
    const auto is_positive = [](double v) { return v > 0 && std::isfinite(v); };
    const auto is_restitution = [](double R) { return R >= 0 && R <= 1; };
    return is_positive(p.epsilon) && is_positive(p.Omega) && is_positive(p.b) && p.lambda >= 0 &&
           std::isfinite(p.lambda) && p.G >= 0 && std::isfinite(p.G) && is_restitution(p.R_plus) &&
           is_restitution(p.R_minus) && std::isfinite(p.gravity) && p.friction >= 0 &&
           std::isfinite(p.friction);
}

int wall_of(const State& s, double b) {
    // x and y are rounded decimals: their difference can miss b by some ulps of the largest of
    // them.
    const double tolerance =
        8 * std::numeric_limits<double>::epsilon() * std::max({std::abs(s.x), std::abs(s.y), b});
    if (std::abs(std::abs(s.x - s.y) - b) > tolerance) return 0;
    return s.x > s.y ? 1 : -1;
}

std::vector<Fault> validate(const Parameters& p, const State& start) {
    std::vector<Fault> faults;
    auto check = [&](const std::string& field, double value, double minimum, double maximum,
                     const std::string& what) {
        if (value >= minimum && value <= maximum) return;  // false for NaN, too
        faults.push_back(
            {field, value, minimum, maximum,
             what + " must lie in [" + format(minimum) + ", " + format(maximum) + "]"});
    };
    for (const ParameterRange& r : ranges)
        check(r.name, r.parameter ? p.*r.parameter : start.*r.state, r.minimum, r.maximum, r.name);
    if (!faults.empty()) return faults;  // the checks below need numbers within their ranges

    if (p.zeta() > zeta_maximum)
        check(
            "lambda", p.lambda, 0, p.lambda / p.zeta() * zeta_maximum,
            "lambda, which with this epsilon gives a damping ratio zeta of " + format(p.zeta()) +
                ",");
    if (!wall_of(start, p.b))
        check(
            "y0", start.y, start.x - p.b, start.x + p.b,
            "y0, so that the ball starts inside its cavity (|x0 - y0| <= b),");
    return faults;
}

}  // namespace vines
