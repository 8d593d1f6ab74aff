#include "plot/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace vines::plot {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Range nothing{infinity, -infinity};  // empty range

// Largest number of steps from zero that doubles still resolve.
constexpr double most_steps = 1e15;

Range extended(const Range& r, double from, double to) {
    return {std::min(r.first, from), std::max(r.second, to)};
}

Range widened(const Range& r, double share) {
    if (!(r.second > r.first)) {
        const double half_width = std::max(0.5, 1e-6 * std::abs(r.first));
        return {r.first - half_width, r.first + half_width};
    }
    const double margin = (r.second - r.first) * share;
    return {r.first - margin, r.second + margin};
}

}  // namespace

double on_ordinate(const Plot& plot, double y) {
    return plot.logarithmic ? std::log10(std::max(y, 0.)) : y;
}

Range error_bar(const Plot& plot, const Curve& curve, std::size_t i) {
    const double y = curve.y[i], error = curve.error.empty() ? 0 : curve.error[i];
    return {on_ordinate(plot, y - error), on_ordinate(plot, y + error)};
}

Range x_range(const std::vector<Plot>& plots) {
    Range x = nothing;
    bool dots = false;
    for (const Plot& p : plots) {
        for (const Curve& c : p.curves) {
            dots = dots || (c.dots && !c.error.empty());
            for (double v : c.x) x = extended(x, v, v);
        }
    }
    if (x.first > x.second) return {0, 1};
    return widened(x, dots ? 0.03 : 0);
}

Range late_range(const std::vector<Curve>& curves) {
    Range range{0, 0};
    for (const Curve& c : curves)
        for (std::size_t i = c.y.size() / 4; i < c.y.size(); ++i)
            if (std::isfinite(c.y[i])) range = extended(range, c.y[i], c.y[i]);
    const double margin = 0.2 * std::max(range.second - range.first, 1e-3);
    return {range.first - margin, range.second + margin};
}

Range y_range(const Plot& plot) {
    if (plot.y_range)
        return {on_ordinate(plot, plot.y_range->first), on_ordinate(plot, plot.y_range->second)};
    Range y = nothing;
    for (const Curve& c : plot.curves) {
        for (std::size_t i = 0; i < c.x.size(); ++i) {
            const double v = on_ordinate(plot, c.y[i]);
            const auto [low, high] = error_bar(plot, c, i);
            if (std::isfinite(v)) y = extended(y, std::isfinite(low) ? low : v, high);
        }
    }
    if (y.first > y.second) y = {0, 1};
    return widened(y, 0.06);
}

std::vector<double> ticks(const Range& r, int count) {
    const double raw = (r.second - r.first) / count,
                 power = std::pow(10, std::floor(std::log10(raw)));
    double step = power;
    for (double m : {2., 5., 10.})
        if (step < raw) step = m * power;
    std::vector<double> list;
    if (!(std::max(std::abs(r.first), std::abs(r.second)) < most_steps * step)) return list;
    for (double k = std::ceil(r.first / step - 1e-9);
         k * step <= r.second * (1 + 1e-12) + 1e-12 * step; ++k)
        list.push_back(k * step);
    return list;
}

std::vector<double> y_ticks(const Plot& plot, const Range& range, int count) {
    std::vector<double> list = ticks(range, count);
    if (plot.logarithmic) std::erase_if(list, [](double t) { return t != std::floor(t); });
    return list;
}

std::string tick_label(double t) { return fmt::format("{:.10g}", t == 0 ? 0 : t); }

std::string y_tick_label(const Plot& plot, double tick) {
    return (plot.logarithmic ? "1e" : "") + tick_label(tick);
}

}  // namespace vines::plot
