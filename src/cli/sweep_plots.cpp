#include "cli/plots.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "api/json_text.hpp"
#include "cli/json_values.hpp"

namespace vines::cli {

namespace {

using api::Json;
using plot::Curve;
using plot::Plot;

/// An axis of the sweep as abscissa.
struct Abscissa {
    std::string parameter;
    double unit;

    std::string label() const { return parameter + (unit == mm ? " (mm)" : ""); }
    double of(const Json& point) const { return number_at(point, parameter) / unit; }
};

/// The axis with more than one value, or the first one if all have one. Throws std::runtime_error
/// if several axes have more than one value.
Abscissa abscissa_of(const Json& start, const std::vector<Json>& points) {
    std::optional<std::string> first, found;
    for (const Json& axis : start["axes"]) {
        const std::string parameter = word_at(axis, "parameter");
        if (word_at(points[0], "reduce").ends_with(" " + parameter)) continue;
        if (!first) first = parameter;
        if (!axis.contains("values") || axis["values"].size() < 2) continue;
        if (found)
            throw std::runtime_error(
                "only a sweep along one axis can be drawn here; the web page draws maps of two");
        found = parameter;
    }
    const std::string parameter = found ? *found : first.value_or("");
    return {parameter, parameter == "b" ? mm : 1};
}

/// Skips values that are not finite.
void add(Curve& curve, double x, double y, std::optional<double> error = {}) {
    if (!std::isfinite(x) || !std::isfinite(y)) return;
    curve.x.push_back(x);
    curve.y.push_back(y);
    if (error) curve.error.push_back(std::isfinite(*error) ? *error : 0);
}

/// States in the section: at impacts (where |x - y| = b) or at whole forcing cycles.
std::optional<Plot> section(const std::vector<Json>& points, const Abscissa& at) {
    const Json::json_pointer states("/section/x");
    Plot p{.y_label = "x in the section (mm)", .curves = {{.dots = true}}};
    for (const Json& point : points) {
        if (!point.contains(states)) continue;
        for (const double x : numbers_of(point[states], mm)) add(p.curves[0], at.of(point), x);
    }
    if (p.curves[0].x.empty()) return std::nullopt;
    return p;
}

/// One curve of dots for each word that a field can have.
std::vector<Curve> by_word(
    const std::vector<Json>& points, const Abscissa& at, const char* field,
    const std::vector<std::pair<std::string, const char*>>& colours,
    const std::function<std::pair<double, double>(const Json&)>& value_and_error) {
    std::vector<Curve> curves;
    for (const auto& [word, colour] : colours) {
        Curve curve{.colour = colour, .label = word, .dots = true};
        for (const Json& point : points) {
            const auto [value, error] = value_and_error(point);
            if (word_at(point, field) == word) add(curve, at.of(point), value, error);
        }
        if (!curve.x.empty()) curves.push_back(std::move(curve));
    }
    return curves;
}

Plot lambda1(const std::vector<Json>& points, const Abscissa& at) {
    return {
        .y_label = "lambda1, by verdict",
        .curves = by_word(
            points, at, "verdict",
            {{"chaotic", plot::red}, {"regular", plot::colours[0]}, {"not_decided", plot::grey}},
            [](const Json& p) {
                return std::pair(first_at(p, "lambda"), first_at(p, "standard_error"));
            }),
        .levels = {0}};
}

Plot response(
    const std::vector<Json>& points, const Abscissa& at, const std::string& label,
    const char* field, double unit) {
    return {
        .y_label = label + ", by regime",
        .curves = by_word(
            points, at, "regime",
            {{"I", "#b8780b"},
             {"II", plot::red},
             {"III", plot::colours[0]},
             {"IV", plot::colours[1]},
             {"V", plot::colours[3]},
             {"VI", "#39424a"},
             {"none", plot::grey}},
            [field, unit](const Json& p) { return std::pair(number_at(p, field) / unit, 0.); })};
}

/// Request fields except axes, as "name = value, ...", including those of the base.
std::string fields_except_axes(const Json& request) {
    std::string text;
    for (const auto& [name, value] : request.items()) {
        if (name == "axes" || name == "indices") continue;
        const std::string part =
            name == "base" ? fields_except_axes(value) : name + " = " + api::json_text(value);
        if (!part.empty()) text += (text.empty() ? "" : ", ") + part;
    }
    return text;
}

}  // namespace

std::vector<Plot> sweep_plots(const Json& start, const std::vector<Json>& points) {
    if (points.empty()) return {};
    const Abscissa at = abscissa_of(start, points);
    std::vector<Plot> plots;
    if (std::optional<Plot> states = section(points, at)) plots.push_back(std::move(*states));
    plots.push_back(lambda1(points, at));
    plots.push_back(response(points, at, "rms ratio of x", "x_rms_ratio", 1));
    plots.push_back(response(points, at, "max |x| (mm)", "x_max", mm));
    plots.push_back(response(points, at, "peak of |x| (mm)", "x_peak", mm));
    std::erase_if(plots, [](const Plot& p) { return p.curves.empty(); });
    for (Plot& p : plots) p.x_label = at.label();
    if (!plots.empty()) plots[0].title = fields_except_axes(start.value("request", Json::object()));
    return plots;
}

}  // namespace vines::cli
