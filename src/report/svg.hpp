// Plots as SVG text.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vines::report {

struct Curve {
    std::vector<double> x{}, y{};  ///< of equal length; what is not finite leaves a gap
    std::string colour = "#1f6fb2";
    std::string label{};          ///< in the legend, if any
    bool dots = false;            ///< points instead of a line
    std::string dash{};           ///< SVG's stroke-dasharray
    std::vector<double> error{};  ///< bars of +- this length, if any
};

struct Plot {
    std::string x_label, y_label;
    std::vector<Curve> curves{};
    bool logarithmic = false;  ///< y
    std::optional<std::pair<double, double>> y_range{};
    std::vector<double> levels{};                    ///< thin lines at y
    std::vector<double> moments{};                   ///< broken lines at x
    std::vector<std::pair<double, double>> bands{};  ///< shaded intervals of x
};

/// Plots over each other in one picture with the same abscissa, `width` wide and `height` high
/// each, in pixels.
std::string svg(const std::vector<Plot>& plots, int width, int height);

}  // namespace vines::report
