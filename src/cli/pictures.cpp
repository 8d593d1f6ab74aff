#include "cli/pictures.hpp"

#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "api/parse_object.hpp"
#include "cli/files.hpp"
#include "cli/numbers.hpp"
#include "cli/output.hpp"
#include "cli/run_plots.hpp"
#include "cli/sweep_plots.hpp"
#include "cli/terminal.hpp"
#include "plot/svg.hpp"
#include "plot/text.hpp"

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
        // The last one of a run that was killed.
        if (lines.eof() && !api::Json::accept(line)) break;
        api::Json read = api::parse_object(line);
        if (word_at(read, "type") == "start") start = std::move(read);
        else if (word_at(read, "type") == "point") points.push_back(std::move(read));
    }
    if (!start.contains("axes") || !start["axes"].is_array())
        throw std::runtime_error("a sweep without its first line");
    return plots_of(start, points);
}

bool is_sweep(const std::string& text) { return text.starts_with(R"({"type":)"); }

/// Whether the terminal's characters are none but ASCII's: it says which ones they are, or nothing.
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

/// See no-color.org.
bool has_colours() {
    const char *const no = std::getenv("NO_COLOR"), *const kind = std::getenv("TERM");
    return !(no && *no) && kind && std::string(kind) != "dumb";
}

/// For a terminal, or for what may be shown in one later.
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
            "nothing to draw: a run's series or exponents, or points of a sweep");
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

}  // namespace vines::cli
