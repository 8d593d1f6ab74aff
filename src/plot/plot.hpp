// What a plot shows, however it is drawn.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vines::plot {

struct Curve {
    std::vector<double> x{}, y{};  ///< of equal length; a y that is not finite leaves a gap
    std::string colour = "#1f6fb2";
    std::string label{};          ///< in the legend, if any
    bool dots = false;            ///< points instead of a line
    std::string dash{};           ///< SVG's stroke-dasharray
    std::vector<double> error{};  ///< bars of +- this length, if any
};

struct Plot {
    std::string x_label{}, y_label{};
    std::vector<Curve> curves{};
    bool logarithmic = false;  ///< y
    std::optional<std::pair<double, double>> y_range{};
    std::vector<double> levels{};                    ///< thin lines at y
    std::vector<double> moments{};                   ///< broken lines at x
    std::vector<std::pair<double, double>> bands{};  ///< shaded intervals of x
    std::string title{};                             ///< above it, if any
};

/// One for each exponent or eigenvalue.
inline const char* const colours[] = {"#1f6fb2", "#2e8b57", "#b8780b", "#8e44ad"};
inline const char* const grey = "#8a939b";
inline const char* const red = "#b3261e";

}  // namespace vines::plot
