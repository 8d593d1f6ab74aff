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

Axes::Axes(const Plot& of, const Range& common_abscissa)
    : plot(of),
      abscissa(common_abscissa),
      ordinate([this] {
          if (plot.y_range) return Range{value(plot.y_range->first), value(plot.y_range->second)};
          Range y = nothing;
          for (const Curve& c : plot.curves)
              for (std::size_t i = 0; i < c.x.size(); ++i) {
                  const double v = value(c.y[i]);
                  const auto [low, high] = error_bar(c, i);
                  if (std::isfinite(v)) y = extended(y, std::isfinite(low) ? low : v, high);
              }
          if (y.first > y.second) y = {0, 1};
          return widened(y, 0.06);
      }()) {}

double Axes::value(double y) const { return plot.logarithmic ? std::log10(std::max(y, 0.)) : y; }

Range Axes::error_bar(const Curve& curve, std::size_t i) const {
    const double y = curve.y[i], error = curve.error.empty() ? 0 : curve.error[i];
    return {value(y - error), value(y + error)};
}

bool Axes::contain(double x, double v) const {
    return x >= abscissa.first && x <= abscissa.second && v >= ordinate.first &&
           v <= ordinate.second;
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

std::string tick_label(double t) { return fmt::format("{:.10g}", t == 0 ? 0 : t); }

std::vector<double> Axes::y_ticks(int count) const {
    std::vector<double> list = ticks(ordinate, count);
    if (plot.logarithmic) std::erase_if(list, [](double t) { return t != std::floor(t); });
    return list;
}

std::string Axes::y_tick_label(double tick) const {
    return (plot.logarithmic ? "1e" : "") + tick_label(tick);
}

}  // namespace vines::plot
