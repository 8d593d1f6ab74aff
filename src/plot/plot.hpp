// Plots: their content, their axes, and their drawing as SVG or in the characters of a terminal.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vines::plot {

using Range = std::pair<double, double>;

struct Curve {
    std::vector<double> x{}, y{};  ///< of equal length; a y that is not finite leaves a gap
    std::string colour = "#1f6fb2";
    std::string label{};          ///< in the legend, if not empty
    bool dots = false;            ///< points instead of a line
    std::string dash{};           ///< SVG's stroke-dasharray; ignored by text()
    std::vector<double> error{};  ///< half-lengths of the error bars; empty or the size of y

    void add(double at, double value) {
        x.push_back(at);
        y.push_back(value);
    }
};

struct Plot {
    std::string x_label{}, y_label{};
    std::vector<Curve> curves{};
    bool logarithmic = false;            ///< y axis; a y <= 0 leaves a gap
    std::optional<Range> y_range{};      ///< automatic if nullopt
    std::vector<double> levels{};        ///< y of thin horizontal lines
    std::vector<double> marked_times{};  ///< x of dashed vertical lines
    std::vector<Range> bands{};          ///< shaded intervals of x
    std::string title{};                 ///< above the plot, if not empty
};

/// Ordinate range of zero and the last three quarters of curves whose first values vary widely.
Range late_range(const std::vector<Curve>& curves);

/// Colour of each exponent or eigenvalue.
inline const char* const colours[] = {"#1f6fb2", "#2e8b57", "#b8780b", "#8e44ad"};
inline const char* const grey = "#8a939b";
inline const char* const red = "#b3261e";

/// Draws the plots as one <svg> document, stacked vertically with a common x axis; each is `width`
/// x `height` pixels. Curves are clipped to the frame; an arrow marks where one leaves y_range.
std::string svg(const std::vector<Plot>& plots, int width, int height);

struct Terminal {
    int width = 80;        ///< characters
    int height = 12;       ///< lines of each plot's frame
    bool colours = false;  ///< ANSI escape sequences
    bool ascii = false;    ///< ASCII only, without Braille dots (eight per character)
};

/// Draws the plots in characters, stacked vertically with a common x axis. Labels stand at the ends
/// of their curves; without colours, curves of points differ by their marks. Bands and marked times
/// are omitted.
std::string text(const std::vector<Plot>& plots, const Terminal& terminal);

/// Common abscissa range of all curves of all plots.
Range x_range(const std::vector<Plot>& plots);
/// About `count` ticks, 1, 2 or 5 times a power of ten apart; none below the values' rounding.
std::vector<double> ticks(const Range& range, int count);
std::string tick_label(double tick);

/// The axes of a plot. v is a position on the ordinate: y, or log10 y if it is logarithmic.
struct Axes {
    Axes(const Plot& of, const Range& common_abscissa);

    const Plot& plot;
    const Range abscissa, ordinate;  ///< ordinate: of v, fixed, or of curves and error bars

    /// v of a value; -infinity for the logarithm of a y <= 0.
    double value(double y) const;
    /// v of the ends of a point's error bar; equal without errors.
    Range error_bar(const Curve& curve, std::size_t i) const;
    bool contain(double x, double v) const;
    /// Ticks of the ordinate; powers of ten if logarithmic.
    std::vector<double> y_ticks(int count) const;
    std::string y_tick_label(double tick) const;
};

}  // namespace vines::plot
