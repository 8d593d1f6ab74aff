// Plots: their content, and how they are drawn, as SVG or in the characters of a terminal.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vines::plot {

struct Curve {
    std::vector<double> x{}, y{};  ///< of equal length; a y that is not finite leaves a gap
    std::string colour = "#1f6fb2";
    std::string label{};          ///< in the legend, if not empty
    bool dots = false;            ///< points instead of a line
    std::string dash{};           ///< SVG's stroke-dasharray
    std::vector<double> error{};  ///< error bars of +- this length, if not empty
};

struct Plot {
    std::string x_label{}, y_label{};
    std::vector<Curve> curves{};
    bool logarithmic = false;  ///< y
    std::optional<std::pair<double, double>> y_range{};
    std::vector<double> levels{};                    ///< thin lines at y
    std::vector<double> marked_times{};              ///< dashed lines at x
    std::vector<std::pair<double, double>> bands{};  ///< shaded intervals of x
    std::string title{};                             ///< above the plot, if not empty
};

/// Colour of each exponent or eigenvalue.
inline const char* const colours[] = {"#1f6fb2", "#2e8b57", "#b8780b", "#8e44ad"};
inline const char* const grey = "#8a939b";
inline const char* const red = "#b3261e";

/// Draws plots above each other with a common abscissa, each `width` x `height` pixels.
std::string svg(const std::vector<Plot>& plots, int width, int height);

struct Terminal {
    int width = 80;        ///< characters
    int height = 12;       ///< lines of each plot's frame
    bool colours = false;  ///< ANSI escape sequences
    bool ascii = false;    ///< ASCII only, without Braille dots (eight per character)
};

/// Draws plots above each other with a common abscissa. Labels stand at the ends of their curves;
/// without colours each curve of points has its own mark; bands are omitted.
std::string text(const std::vector<Plot>& plots, const Terminal& terminal);

}  // namespace vines::plot
