#include "cli/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "api/schema/field.hpp"
#include "cli/json_values.hpp"

namespace vines::cli {

namespace {

using api::Json;
using plot::Curve;
using plot::Plot;

/// Value at a JSON pointer such as "/exponents/qr"; null if missing.
const Json& part(const Json& answer, const std::string& path) {
    static const Json none;
    const Json::json_pointer at(path);
    return answer.contains(at) ? answer[at] : none;
}

/// Returns whether the object has these lists with equal lengths and the first has no gaps.
bool has(const Json& object, const std::vector<const char*>& names) {
    const auto is_list = [&](const char* name) {
        return object.contains(name) && object[name].is_array() && !object[name].empty() &&
               object[name].size() == object[names[0]].size();
    };
    return std::all_of(names.begin(), names.end(), is_list) &&
           std::all_of(object[names[0]].begin(), object[names[0]].end(), [](const Json& entry) {
               return entry.is_number();
           });
}

/// lambda1 with its standard error, if known; empty if lambda1 is missing.
std::string lambda1_of(const Json& qr) {
    const double lambda1 = first_at(qr, "final"), error = first_at(qr, "standard_error");
    if (!std::isfinite(lambda1)) return "";
    return fmt::format("lambda1 = {:.3g}", lambda1) +
           (std::isfinite(error) ? fmt::format(" +- {:.2g}", error) : "");
}

/// Result of the run in one line.
std::string title_of(const Json& answer) {
    const double b = number_at(part(answer, "/parameters"), "b") / mm;
    const std::string regime = word_at(part(answer, "/regime"), "type");
    std::vector<std::string> parts = {
        regime.empty() ? "" : "regime " + regime, word_at(part(answer, "/exponents"), "verdict"),
        lambda1_of(part(answer, "/exponents/qr"))};
    std::erase(parts, "");
    if (!std::isfinite(b)) return api::joined(parts);
    return fmt::format("b = {:.4g} mm", b) + (parts.empty() ? "" : ": ") + api::joined(parts);
}

Plot displacement(const Json& series) {
    return {
        .x_label = "tau",
        .y_label = "x (mm)",
        .curves = {{.x = numbers_of(series["tau"]), .y = numbers_of(series["x"], mm)}}};
}

/// Includes the contacts between the samples, where |y - x| = b.
Plot relative_displacement(const Json& answer) {
    const Json &series = answer["series"], &impacts = part(answer, "/impacts");
    const double b = number_at(part(answer, "/parameters"), "b") / mm;
    const bool has_walls = std::isfinite(b);
    std::vector<std::pair<double, double>> points;
    const std::vector<double> tau = numbers_of(series["tau"]), x = numbers_of(series["x"], mm),
                              y = numbers_of(series["y"], mm);
    for (std::size_t i = 0; i < tau.size(); ++i) points.emplace_back(tau[i], y[i] - x[i]);
    if (has_walls && has(impacts, {"tau", "side"})) {
        const std::vector<double> at = numbers_of(impacts["tau"]),
                                  side = numbers_of(impacts["side"]);
        for (std::size_t n = 0; n < at.size(); ++n)
            if (at[n] >= tau.front() && at[n] <= tau.back())
                points.emplace_back(at[n], -side[n] * b);
    }
    std::stable_sort(points.begin(), points.end(), [](const auto& a, const auto& c) {
        return a.first < c.first;
    });
    Curve curve;
    for (const auto& [at, gap] : points) {
        curve.x.push_back(at);
        curve.y.push_back(gap);
    }
    Plot p{.x_label = "tau", .y_label = "y - x (mm)", .curves = {std::move(curve)}};
    if (has_walls) {  // visible even if the motion does not reach them
        p.y_range = {-1.12 * b, 1.12 * b};
        p.levels = {-b, b};
    }
    return p;
}

/// Range of the last three quarters of all curves: the first values vary widely.
std::pair<double, double> late_range(const std::vector<Curve>& curves) {
    std::pair<double, double> range{0, 0};
    for (const Curve& c : curves)
        for (std::size_t i = c.y.size() / 4; i < c.y.size(); ++i)
            if (std::isfinite(c.y[i]))
                range = {std::min(range.first, c.y[i]), std::max(range.second, c.y[i])};
    const double margin = 0.2 * std::max(range.second - range.first, 1e-3);
    return {range.first - margin, range.second + margin};
}

Plot exponents(const Json& history) {
    Plot p{.x_label = "tau", .y_label = "exponents (qr)", .levels = {0}};
    for (int k = 0; k < 4; ++k) {
        const std::string name = fmt::format("lambda{}", k + 1);
        if (!has(history, {"tau", name.c_str()})) continue;
        p.curves.push_back(
            {.x = numbers_of(history["tau"]),
             .y = numbers_of(history[name]),
             .colour = plot::colours[k],
             .label = name});
    }
    p.y_range = late_range(p.curves);
    return p;
}

}  // namespace

std::vector<Plot> run_plots(const Json& answer) {
    std::vector<Plot> plots;
    const Json &series = part(answer, "/series"), &history = part(answer, "/exponents/qr/history");
    if (has(series, {"tau", "x"})) plots.push_back(displacement(series));
    if (has(series, {"tau", "x", "y"})) plots.push_back(relative_displacement(answer));
    if (has(history, {"tau", "lambda1"})) plots.push_back(exponents(history));
    if (!plots.empty()) plots[0].title = title_of(answer);
    return plots;
}

}  // namespace vines::cli
