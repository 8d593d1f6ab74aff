// Plots of answers, drawn as SVG or in characters; `vines plot`.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <memory>
#include <sstream>

#include "api/json_text.hpp"
#include "api/parse.hpp"
#include "api/problem.hpp"
#include "api/schema/field.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/terminal.hpp"
#include "plot/plot.hpp"

namespace vines::cli {

namespace {

using api::Json;
using plot::Curve;
using plot::Plot;

constexpr double mm = 1e-3;  // m; unit of lengths

// --- A run ---

/// Returns whether the object has these lists with equal lengths and the first has no gaps.
bool has(const Json& object, const std::vector<const char*>& names) {
    const auto is_list = [&](const char* name) {
        return object.contains(name) && object[name].is_array() && !object[name].empty() &&
               object[name].size() == object[names[0]].size();
    };
    return std::ranges::all_of(names, is_list) &&
           std::ranges::all_of(object[names[0]], &Json::is_number);
}

/// lambda1 with its standard error, if known; empty if lambda1 is missing.
std::string lambda1_of(const Json& qr) {
    const double lambda1 = number_of(part(qr, "/final/0")),
                 error = number_of(part(qr, "/standard_error/0"));
    if (!std::isfinite(lambda1)) return "";
    return fmt::format("lambda1 = {:.3g}", lambda1) +
           (std::isfinite(error) ? fmt::format(" +- {:.2g}", error) : "");
}

/// Result of the run in one line.
std::string title_of(const Json& answer) {
    const double b = number_of(part(answer, "/parameters/b")) / mm;
    const std::string regime = word_of(part(answer, "/regime/type"));
    std::vector<std::string> parts = {
        regime.empty() ? "" : "regime " + regime, word_of(part(answer, "/exponents/verdict")),
        lambda1_of(part(answer, "/exponents/qr"))};
    std::erase(parts, "");
    if (!std::isfinite(b)) return api::joined(parts);
    return fmt::format("b = {:.4g} mm", b) + (parts.empty() ? "" : ": ") + api::joined(parts);
}

/// Includes the contacts between the samples, where |y - x| = b.
Plot relative_displacement(const Json& answer) {
    const Json &series = answer["series"], &impacts = part(answer, "/impacts");
    const double b = number_of(part(answer, "/parameters/b")) / mm;
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
    std::ranges::stable_sort(points, {}, &std::pair<double, double>::first);
    Curve curve;
    for (const auto& [at, gap] : points) curve.add(at, gap);
    Plot p{.x_label = "tau", .y_label = "y - x (mm)", .curves = {std::move(curve)}};
    if (has_walls) {  // visible even if the motion does not reach them
        p.y_range = {-1.12 * b, 1.12 * b};
        p.levels = {-b, b};
    }
    return p;
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
    p.y_range = plot::late_range(p.curves);
    return p;
}

/// Plots of x, of y - x with its contacts, and of the exponents' history by QR, as far as present.
std::vector<Plot> run_plots(const Json& answer) {
    std::vector<Plot> plots;
    const Json &series = part(answer, "/series"), &history = part(answer, "/exponents/qr/history");
    if (has(series, {"tau", "x"}))
        plots.push_back(
            {.x_label = "tau",
             .y_label = "x (mm)",
             .curves = {{.x = numbers_of(series["tau"]), .y = numbers_of(series["x"], mm)}}});
    if (has(series, {"tau", "x", "y"})) plots.push_back(relative_displacement(answer));
    if (has(history, {"tau", "lambda1"})) plots.push_back(exponents(history));
    if (!plots.empty()) plots[0].title = title_of(answer);
    return plots;
}

// --- A sweep ---

/// An axis of the sweep as abscissa.
struct Abscissa {
    std::string parameter;
    double unit;

    std::string label() const { return parameter + (unit == mm ? " (mm)" : ""); }
    double of(const Json& point) const { return number_of(point.value(parameter, Json())) / unit; }
};

/// The axis with more than one value, or the first one. Throws std::runtime_error if several have.
Abscissa abscissa_of(const Json& start, const std::vector<Json>& points) {
    std::optional<std::string> first, found;
    for (const Json& axis : start["axes"]) {
        const std::string parameter = word_of(part(axis, "/parameter"));
        if (word_of(part(points[0], "/reduce")).ends_with(" " + parameter)) continue;
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
    curve.add(x, y);
    if (error) curve.error.push_back(std::isfinite(*error) ? *error : 0);
}

/// States in the section: at impacts (where |x - y| = b) or at whole forcing cycles.
Plot section(const std::vector<Json>& points, const Abscissa& at) {
    Plot p{.y_label = "x in the section (mm)", .curves = {{.dots = true}}};
    for (const Json& point : points)
        for (const double x : numbers_of(part(point, "/section/x"), mm))
            add(p.curves[0], at.of(point), x);
    return p;
}

/// The words that a field of a point can have, each with its colour.
struct Words {
    std::string field;
    std::vector<std::pair<std::string, const char*>> colours;
};
const Words verdicts = {
    "verdict",
    {{"chaotic", plot::red}, {"regular", plot::colours[0]}, {"not_decided", plot::grey}}};
const Words regimes = {
    "regime",
    {{"I", "#b8780b"},
     {"II", plot::red},
     {"III", plot::colours[0]},
     {"IV", plot::colours[1]},
     {"V", plot::colours[3]},
     {"VI", "#39424a"},
     {"none", plot::grey}}};

/// A number of the points, as one curve of dots for each word. `value`, `error`: JSON pointers.
Plot by_word(
    const std::vector<Json>& points, const Abscissa& at, const Words& words,
    const std::string& label, const char* value, double unit = 1, const char* error = nullptr) {
    Plot p{.y_label = label + ", by " + words.field};
    for (const auto& [word, colour] : words.colours) {
        Curve curve{.colour = colour, .label = word, .dots = true};
        for (const Json& point : points)
            if (word_of(part(point, "/" + words.field)) == word)
                add(curve, at.of(point), number_of(part(point, value)) / unit,
                    error ? number_of(part(point, error)) : 0);
        if (!curve.x.empty()) p.curves.push_back(std::move(curve));
    }
    return p;
}

/// Request fields except axes, as "name = value, ...", including those of the base.
std::string fields_except_axes(const Json& request) {
    std::vector<std::string> parts;
    for (const auto& [name, value] : request.items())
        if (name != "axes" && name != "indices")
            parts.push_back(
                name == "base" ? fields_except_axes(value) : name + " = " + api::json_text(value));
    std::erase(parts, "");
    return api::joined(parts);
}

/// Plots of the section (bifurcation diagram), of lambda1 by verdict, and of the response by regime
/// (the peaks, for a reduced sweep), as far as present.
std::vector<Plot> sweep_plots(const std::string& text) {
    std::istringstream lines(text);
    Json start;
    std::vector<Json> points;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty()) continue;
        // The last line of a killed run can be incomplete.
        if (lines.eof() && !Json::accept(line)) break;
        Json read = api::parse_object(line);
        const std::string type = word_of(part(read, "/type"));
        if (type == "start") start = std::move(read);
        else if (type == "point") points.push_back(std::move(read));
    }
    if (!start.contains("axes") || !start["axes"].is_array())
        throw std::runtime_error("the first line of the sweep is missing");
    if (points.empty()) return {};
    const Abscissa at = abscissa_of(start, points);
    std::vector<Plot> plots = {
        section(points, at),
        by_word(points, at, verdicts, "lambda1", "/lambda/0", 1, "/standard_error/0"),
        by_word(points, at, regimes, "rms ratio of x", "/x_rms_ratio"),
        by_word(points, at, regimes, "max |x| (mm)", "/x_max", mm),
        by_word(points, at, regimes, "peak of |x| (mm)", "/x_peak", mm)};
    plots[1].levels = {0};
    std::erase_if(plots, [](const Plot& p) { return p.curves.empty() || p.curves[0].x.empty(); });
    for (Plot& p : plots) p.x_label = at.label();
    if (!plots.empty()) plots[0].title = fields_except_axes(start.value("request", Json::object()));
    return plots;
}

// --- Drawing ---

constexpr int picture_width = 860, plot_height = 230;  // px

/// Returns whether the locale states a character set other than UTF-8.
bool has_ascii_alone() {
    for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
        const char* const value = std::getenv(name);
        if (!value || !*value) continue;
        const std::string locale = CLI::detail::to_lower(value);
        return locale.find("utf-8") == std::string::npos &&
               locale.find("utf8") == std::string::npos;
    }
    return false;
}

/// NO_COLOR: see no-color.org.
bool has_colours() {
    const char *const no = std::getenv("NO_COLOR"), *const kind = std::getenv("TERM");
    return !(no && *no) && kind && std::string(kind) != "dumb";
}

/// For the terminal, or for a text that can be shown in one later.
std::string in_characters(const std::vector<Plot>& plots, bool is_stdout) {
    const std::size_t width = is_stdout ? terminal_width(STDOUT_FILENO) : 0;
    return plot::text(
        plots, {.width = static_cast<int>(width > 0 ? width : usual_terminal_width),
                .height = plots.size() > 2 ? 8 : 12,
                .colours = width > 0 && has_colours(),
                .ascii = has_ascii_alone()});
}

}  // namespace

void check_plot_file(const std::string& path) {
    constexpr std::string_view others[] = {".pdf", ".png", ".jpg",  ".jpeg", ".gif", ".webp",
                                           ".eps", ".ps",  ".tiff", ".tif",  ".bmp"};
    const std::string ending = CLI::detail::to_lower(std::filesystem::path(path).extension());
    if (std::ranges::find(others, ending) != std::end(others))
        throw api::Problem(
            422,
            fmt::format(
                "{}: plots are SVG (FILE.svg) or text; rsvg-convert and Inkscape convert SVG to {}",
                path, ending.substr(1)));
}

void draw(const std::string& answer, const std::string& path) {
    const bool is_sweep = answer.starts_with(R"({"type":)");
    const std::vector<Plot> plots =
        is_sweep ? sweep_plots(answer) : run_plots(api::parse_object(answer));
    if (plots.empty())
        throw std::runtime_error(
            "nothing to draw: plots need a run's series or exponents, or points of a sweep");
    write_all(
        path, path.ends_with(".svg") ? plot::svg(plots, picture_width, plot_height)
                                     : in_characters(plots, is_standard(path)));
}

Command add_plot(CLI::App& app) {
    const auto files = std::make_shared<Files>();
    CLI::App* command = app.add_subcommand("plot", "draw an answer in the terminal or as SVG");
    add_file(
        *command, "answer", files->input,
        "file with a run's answer or a sweep's lines; - or nothing: stdin");
    add_output(*command, files->output, "SVG file, FILE.svg; nothing: draw in the terminal");
    return with_exit_codes(
        command,
        [files] {
            check_plot_file(files->output);
            draw(read_all(files->input), files->output);
            return complete;
        },
        "vines simulate -p preset=fig11 -o answer.json; vines plot answer.json\n"
        "vines plot sweep.ndjson -o sweep.svg");
}

}  // namespace vines::cli
