#include "cli/sweep_plots.hpp"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "api/json_text.hpp"
#include "cli/numbers.hpp"

namespace vines::cli {

namespace {

using api::Json;
using plot::Curve;
using plot::Plot;

constexpr double mm = 1e-3;  // m

/// An axis, and the numbers of a line's quantity along it.
struct Abscissa {
    std::string parameter;
    double unit;

    std::string label() const { return parameter + (unit == mm ? " (mm)" : ""); }
    double of(const Json& point) const { return number_at(point, parameter) / unit; }
};

/// The one axis that has several values; none: there are more, or a line does not name it.
std::optional<Abscissa> abscissa_of(const Json& start, const std::vector<Json>& points) {
    std::optional<Abscissa> found;
    for (const Json& axis : start["axes"]) {
        const std::string parameter = word_at(axis, "parameter");
        const bool varies = axis["values"].size() > 1 || start["axes"].size() == 1;
        if (!varies || (word_at(points[0], "reduce").ends_with(" " + parameter))) continue;
        if (found) return std::nullopt;
        found = {parameter, parameter == "b" ? mm : 1};
    }
    return found;
}

void add(Curve& curve, double x, double y) {
    curve.x.push_back(x);
    curve.y.push_back(y);
}

/// What is drawn of a section's states: at impact, where all have |x - y| = b, as at whole cycles.
std::optional<Plot> section(const std::vector<Json>& points, const Abscissa& at) {
    Plot p{.y_label = "x in the section (mm)", .curves = {{.dots = true}}};
    for (const Json& point : points) {
        if (!point.contains("section")) continue;
        for (const double x : numbers_of(point["section"]["x"], mm))
            add(p.curves[0], at.of(point), x);
    }
    if (p.curves[0].x.empty()) return std::nullopt;
    return p;
}

/// A curve of dots for each word that a field has.
std::vector<Curve> by_word(
    const std::vector<Json>& points, const Abscissa& at, const char* field,
    const std::vector<std::pair<std::string, const char*>>& colours,
    const std::function<std::pair<double, double>(const Json&)>& value_and_error) {
    std::vector<Curve> curves;
    for (const auto& [word, colour] : colours) {
        Curve curve{.colour = colour, .label = word, .dots = true};
        for (const Json& point : points) {
            const auto [value, error] = value_and_error(point);
            if (word_at(point, field) != word || !std::isfinite(value)) continue;
            add(curve, at.of(point), value);
            curve.error.push_back(std::isfinite(error) ? error : 0);
        }
        if (!curve.x.empty()) curves.push_back(std::move(curve));
    }
    return curves;
}

double first_of(const Json& point, const char* field) {
    const auto list = point.find(field);
    return list != point.end() && list->is_array() && !list->empty() && (*list)[0].is_number()
               ? (*list)[0].get<double>()
               : std::numeric_limits<double>::quiet_NaN();
}

Plot lambda1(const std::vector<Json>& points, const Abscissa& at) {
    return {
        .y_label = "lambda1, by verdict",
        .curves = by_word(
            points, at, "verdict",
            {{"chaotic", plot::red}, {"regular", plot::colours[0]}, {"not_decided", plot::grey}},
            [](const Json& p) {
                return std::pair(first_of(p, "lambda"), first_of(p, "standard_error"));
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

/// What was asked for: name = value of each, those of the base among them.
std::string given_beside_axes(const Json& request) {
    std::string text;
    for (const auto& [name, value] : request.items()) {
        if (name == "axes" || name == "indices") continue;
        const std::string told =
            name == "base" ? given_beside_axes(value) : name + " = " + api::json_text(value);
        if (!told.empty()) text += (text.empty() ? "" : ", ") + told;
    }
    return text;
}

}  // namespace

std::vector<Plot> sweep_plots(const Json& start, const std::vector<Json>& points) {
    if (points.empty()) return {};
    const std::optional<Abscissa> at = abscissa_of(start, points);
    if (!at) return {};
    std::vector<Plot> plots;
    if (std::optional<Plot> states = section(points, *at)) plots.push_back(std::move(*states));
    plots.push_back(lambda1(points, *at));
    plots.push_back(response(points, *at, "rms ratio of x", "x_rms_ratio", 1));
    plots.push_back(response(points, *at, "max |x| (mm)", "x_max", mm));
    plots.push_back(response(points, *at, "peak of |x| (mm)", "x_peak", mm));
    std::erase_if(plots, [](const Plot& p) { return p.curves.empty(); });
    for (Plot& p : plots) p.x_label = at->label();
    if (!plots.empty()) plots[0].title = given_beside_axes(start["request"]);
    return plots;
}

}  // namespace vines::cli
