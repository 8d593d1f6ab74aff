#include "cli/run_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "cli/numbers.hpp"

namespace vines::cli {

namespace {

using api::Json;
using plot::Curve;
using plot::Plot;

constexpr double mm = 1e-3;  // m

/// lambda1 with its standard error, if any; empty without.
std::string lambda1_of(const Json& exponents) {
    const Json& qr = exponents["qr"];
    if (!qr["final"][0].is_number()) return "";
    const Json& error = qr["standard_error"][0];
    return fmt::format(", lambda1 = {:.3g}", qr["final"][0].get<double>()) +
           (error.is_number() ? fmt::format(" +- {:.2g}", error.get<double>()) : "");
}

/// What the run came to, in a line.
std::string title_of(const Json& answer) {
    std::string title = fmt::format("b = {:.4g} mm", number_at(answer["parameters"], "b") / mm);
    if (answer.contains("regime")) title += ": regime " + word_at(answer["regime"], "type");
    if (answer.contains("exponents"))
        title += ", " + word_at(answer["exponents"], "verdict") + lambda1_of(answer["exponents"]);
    return title;
}

Plot displacement(const Json& series) {
    return {
        .x_label = "tau",
        .y_label = "x (mm)",
        .curves = {{.x = numbers_of(series["tau"]), .y = numbers_of(series["x"], mm)}}};
}

/// With the contacts between the samples.
Plot relative_displacement(const Json& answer) {
    const Json &series = answer["series"], &parameters = answer["parameters"];
    const double b = number_at(parameters, "b") / mm;
    std::vector<std::pair<double, double>> points;
    const std::vector<double> tau = numbers_of(series["tau"]), x = numbers_of(series["x"], mm),
                              y = numbers_of(series["y"], mm);
    for (std::size_t i = 0; i < tau.size(); ++i) points.emplace_back(tau[i], y[i] - x[i]);
    if (answer.contains("impacts")) {
        const std::vector<double> at = numbers_of(answer["impacts"]["tau"]),
                                  side = numbers_of(answer["impacts"]["side"]);
        for (std::size_t n = 0; n < at.size(); ++n)
            if (!tau.empty() && at[n] >= tau.front() && at[n] <= tau.back())
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
    return {
        .x_label = "tau", .y_label = "y - x (mm)", .curves = {std::move(curve)}, .levels = {-b, b}};
}

/// Of the later values of all curves: the first ones swing widely.
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
        p.curves.push_back(
            {.x = numbers_of(history["tau"]),
             .y = numbers_of(history[name]),
             .colour = plot::colours[k],
             .label = name});
    }
    p.y_range = late_range(p.curves);
    return p;
}

bool has(const Json& object, const std::vector<const char*>& names) {
    return std::all_of(names.begin(), names.end(), [&object](const char* name) {
        return object.contains(name) && object[name].is_array() && !object[name].empty();
    });
}

}  // namespace

std::vector<Plot> run_plots(const Json& answer) {
    std::vector<Plot> plots;
    if (answer.contains("series") && has(answer["series"], {"tau", "x"}))
        plots.push_back(displacement(answer["series"]));
    if (answer.contains("series") && has(answer["series"], {"tau", "x", "y"}))
        plots.push_back(relative_displacement(answer));
    const auto history = Json::json_pointer("/exponents/qr/history");
    if (answer.contains(history) && has(answer[history], {"tau", "lambda1"}))
        plots.push_back(exponents(answer[history]));
    if (!plots.empty()) plots[0].title = title_of(answer);
    return plots;
}

}  // namespace vines::cli
