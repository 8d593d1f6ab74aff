// `vines plot`: draws an answer as SVG or in characters.
#include "cli/plots.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "api/parse.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/files.hpp"
#include "cli/json_values.hpp"
#include "cli/output.hpp"
#include "cli/terminal.hpp"
#include "plot/plot.hpp"

namespace vines::cli {

namespace {

using plot::Plot;

constexpr int picture_width = 860, plot_height = 230;  // px

std::vector<Plot> plots_of_lines(const std::string& text) {
    std::istringstream lines(text);
    api::Json start;
    std::vector<api::Json> points;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty()) continue;
        // The last line of a killed run can be incomplete.
        if (lines.eof() && !api::Json::accept(line)) break;
        api::Json read = api::parse_object(line);
        if (word_at(read, "type") == "start") start = std::move(read);
        else if (word_at(read, "type") == "point") points.push_back(std::move(read));
    }
    if (!start.contains("axes") || !start["axes"].is_array())
        throw std::runtime_error("the first line of the sweep is missing");
    return plots_of(start, points);
}

bool is_sweep(const std::string& text) { return text.starts_with(R"({"type":)"); }

/// Returns whether the locale states a character set other than UTF-8. Without a locale it is
/// false.
bool has_ascii_alone() {
    for (const char* name : {"LC_ALL", "LC_CTYPE", "LANG"}) {
        const char* const value = std::getenv(name);
        if (!value || !*value) continue;
        std::string locale = value;
        std::transform(locale.begin(), locale.end(), locale.begin(), [](unsigned char c) {
            return static_cast<char>(std::tolower(c));
        });
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

std::vector<Plot> drawable(std::vector<Plot> plots) {
    if (plots.empty())
        throw std::runtime_error(
            "nothing to draw: plots need a run's series or exponents, or points of a sweep");
    return plots;
}

}  // namespace

std::vector<Plot> plots_of(const api::Json& start, const std::vector<api::Json>& points) {
    return drawable(sweep_plots(start, points));
}

std::vector<Plot> plots_of(const std::string& answer) {
    return is_sweep(answer) ? plots_of_lines(answer)
                            : drawable(run_plots(api::parse_object(answer)));
}

void draw(const std::vector<Plot>& plots, const std::string& path) {
    write_all(
        path, path.ends_with(".svg") ? plot::svg(plots, picture_width, plot_height)
                                     : in_characters(plots, is_standard(path)));
}

Command add_plot(CLI::App& app) {
    const auto files = std::make_shared<Files>();
    CLI::App* command = app.add_subcommand("plot", "draw an answer in the terminal or as SVG");
    command
        ->add_option(
            "answer", files->input,
            "file with a run's answer or a sweep's lines; - or nothing: stdin")
        ->type_name("FILE");
    command
        ->add_option(
            "--output,-o", files->output, "SVG file, FILE.svg; nothing: draw in the terminal")
        ->type_name("FILE");
    return with_exit_codes(
        command,
        [files] {
            draw(plots_of(read_all(files->input)), files->output);
            return static_cast<int>(complete);
        },
        "vines simulate -p preset=fig11 -o answer.json; vines plot answer.json\n"
        "vines plot sweep.ndjson -o sweep.svg");
}

}  // namespace vines::cli
