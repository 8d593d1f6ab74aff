// Plots as text. Each character holds 2 x 4 Braille dots (in ASCII it is a "*"); coordinates count
// dots from the upper left.
#include "plot/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <map>

namespace vines::plot {

namespace {

constexpr int min_label_width = 7;             // of the ordinate, characters
constexpr int min_width = 20, min_height = 4;  // inside the frame, characters

constexpr int dots_across = 2, dots_down = 4;  // dots of a Braille character

/// Unicode Braille pattern with these dots, in UTF-8.
std::string braille(unsigned dots) {
    const unsigned code = 0x2800 + dots;
    return {
        static_cast<char>(0xE0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 0x3F)),
        static_cast<char>(0x80 | (code & 0x3F))};
}

/// Bit of a dot, counted from the upper left.
unsigned braille_dot(int across, int down) {
    constexpr std::array<std::array<unsigned, dots_down>, dots_across> bits = {
        {{0x01, 0x02, 0x04, 0x40}, {0x08, 0x10, 0x20, 0x80}}};
    return bits[static_cast<std::size_t>(across)][static_cast<std::size_t>(down)];
}

/// Number of the colour in the 6 x 6 x 6 colour cube of terminals that is nearest to "#rrggbb".
int terminal_colour(const std::string& hex) {
    constexpr std::array levels = {0, 95, 135, 175, 215, 255};
    const auto level = [&](std::size_t at) {
        const int wanted = std::stoi(hex.substr(at, 2), nullptr, 16);
        const auto nearest = std::ranges::min_element(
            levels, {}, [wanted](int shown) { return std::abs(shown - wanted); });
        return static_cast<int>(nearest - levels.begin());
    };
    return 16 + 36 * level(1) + 6 * level(3) + level(5);
}

/// Length of a UTF-8 text in characters.
int length(const std::string& text) {
    return static_cast<int>(
        std::ranges::count_if(text, [](char c) { return (c & '\xC0') != '\x80'; }));
}

int lines_of(const Terminal& terminal) { return std::max(terminal.height, min_height); }
int y_ticks_of(const Terminal& terminal) { return std::max(lines_of(terminal) / 3, 2); }

/// Widths of the frame in characters.
struct Layout {
    int left;   ///< left margin for the ordinate's labels and the axis
    int width;  ///< inside the frame
};

// Marks of curves of points; they distinguish the curves on a terminal without colours.
constexpr std::array unicode_marks = {"•", "×", "+", "◦", "▪", "▵", "◇"};
constexpr std::array ascii_marks = {"o", "x", "+", "#", "@", "%", "&"};

/// One plot; Axes has its ranges and ticks.
class TextPlot : Axes {
public:
    TextPlot(const Plot& of, const Range& x, const Layout& layout, const Terminal& terminal)
        : Axes(of, x),
          terminal_(terminal),
          left_(layout.left),
          width_(layout.width),
          height_(lines_of(terminal)),
          cells_(static_cast<std::size_t>(width_ * height_)) {
        for (double level : plot.levels) rule_across(value(level));
        for (const Curve& c : plot.curves) c.dots ? draw_points(c) : draw_line(c);
    }

    std::string draw() {
        std::string out;
        if (!plot.title.empty()) out += plot.title + "\n";
        out += plot.y_label + "\n";
        std::map<int, std::string> at_ticks, at_ends = end_labels();
        for (double t : y_ticks(y_ticks_of(terminal_)))
            at_ticks[down(t) / dots_down] = y_tick_label(t);
        for (int row = 0; row < height_; ++row) {
            const auto tick = at_ticks.find(row), end = at_ends.find(row);
            out += fmt::format(
                "{:>{}} {}", tick == at_ticks.end() ? "" : tick->second, left_ - 2,
                terminal_.ascii          ? "|"
                : tick == at_ticks.end() ? "│"
                                         : "┤");
            for (int column = 0; column < width_; ++column) out += shown(cell(column, row));
            if (end != at_ends.end()) out += " " + end->second;
            out.erase(out.find_last_not_of(' ') + 1);
            out += "\n";
        }
        return out;
    }

private:
    struct Cell {
        unsigned dots = 0;             ///< bits of the Braille pattern
        const Curve* curve = nullptr;  ///< the last curve with a dot here
        /// Mark of a rule, which dots hide, or of a point, which is shown in place of its dots.
        const char* mark = nullptr;
        bool is_point = false;  ///< the mark is that of a point
    };

    Cell& cell(int column, int row) {
        return cells_[static_cast<std::size_t>(row * width_ + column)];
    }

    /// Dot coordinates from the left and from the top.
    int across(double x) const {
        return static_cast<int>(std::lround(
            (x - abscissa.first) / (abscissa.second - abscissa.first) *
            (width_ * dots_across - 1)));
    }
    int down(double v) const {
        const double bounded = std::clamp(v, ordinate.first, ordinate.second);
        return static_cast<int>(std::lround(
            (ordinate.second - bounded) / (ordinate.second - ordinate.first) *
            (height_ * dots_down - 1)));
    }
    void dot(int from_left, int from_top, const Curve& curve) {
        Cell& c = cell(from_left / dots_across, from_top / dots_down);
        c.dots |= braille_dot(from_left % dots_across, from_top % dots_down);
        c.curve = &curve;
    }

    void rule_across(double v) {
        if (!contain(abscissa.first, v)) return;
        for (int column = 0; column < width_; ++column)
            cell(column, down(v) / dots_down).mark = terminal_.ascii ? "-" : "┄";
    }

    /// Draws a straight line from (x1, v1) to (x2, v2).
    void stroke(double x1, double v1, double x2, double v2, const Curve& curve) {
        const int a = across(x1), b = across(x2), c = down(v1), d = down(v2),
                  steps = std::max({std::abs(b - a), std::abs(d - c), 1});
        for (int k = 0; k <= steps; ++k)
            dot(static_cast<int>(std::lround(a + (b - a) * (1. * k / steps))),
                static_cast<int>(std::lround(c + (d - c) * (1. * k / steps))), curve);
    }

    void draw_line(const Curve& c) {
        for (std::size_t i = 0; i < c.x.size(); ++i) {
            const double v = value(c.y[i]);
            if (!std::isfinite(v)) continue;
            const double before = i > 0 ? value(c.y[i - 1]) : v;
            const std::size_t from = i > 0 && std::isfinite(before) ? i - 1 : i;
            // After a gap a line begins with a single dot.
            stroke(c.x[from], from == i ? v : before, c.x[i], v, c);
        }
    }

    void draw_points(const Curve& c) {
        const bool is_marked = has_marks(c);
        for (std::size_t i = 0; i < c.x.size(); ++i) {
            const double x = c.x[i], v = value(c.y[i]);
            if (!contain(x, v)) continue;
            const auto [low, high] = error_bar(c, i);
            stroke(x, low, x, high, c);
            if (!is_marked) continue;
            Cell& at = cell(across(x) / dots_across, down(v) / dots_down);
            at.mark = point_mark(c);
            at.is_point = true;
        }
    }
    bool has_marks(const Curve& c) const {
        return c.dots && c.x.size() <= static_cast<std::size_t>(width_);
    }
    const char* point_mark(const Curve& c) const {
        const auto& marks = terminal_.ascii ? ascii_marks : unicode_marks;
        const auto k = static_cast<std::size_t>(&c - plot.curves.data());
        return marks[terminal_.colours ? 0 : k % marks.size()];
    }

    std::string shown(const Cell& c) const {
        if (!c.curve) return c.mark ? c.mark : " ";
        const std::string character = c.is_point ? c.mark : terminal_.ascii ? "*" : braille(c.dots);
        return coloured(character, *c.curve);
    }
    std::string coloured(const std::string& what, const Curve& curve) const {
        if (!terminal_.colours) return what;
        return fmt::format("\x1b[38;5;{}m{}\x1b[0m", terminal_colour(curve.colour), what);
    }

    /// Labels by row: where the curve ends, else at the next free row below, else above.
    std::map<int, std::string> end_labels() const {
        std::map<int, std::string> labels;
        for (const Curve& c : plot.curves) {
            if (c.label.empty()) continue;
            int row = height_ - 1;
            for (std::size_t i = 0; i < c.x.size(); ++i)
                if (std::isfinite(value(c.y[i]))) row = down(value(c.y[i])) / dots_down;
            const int wanted = row;
            while (labels.contains(row) && row < height_) ++row;
            if (row == height_) row = wanted;
            while (labels.contains(row) && row > 0) --row;
            labels[row] = coloured(has_marks(c) ? point_mark(c) + (" " + c.label) : c.label, c);
        }
        return labels;
    }

    const Terminal& terminal_;
    const int left_, width_, height_;
    std::vector<Cell> cells_;
};

int longest_label(const std::vector<Plot>& plots) {
    int longest = 0;
    for (const Plot& p : plots)
        for (const Curve& c : p.curves)
            longest = std::max(
                longest, length(c.label) + (c.dots && !c.label.empty() ? 2 : 0));  // its mark
    return longest;
}

Layout layout_of(const std::vector<Plot>& plots, const Terminal& terminal) {
    int label_width = min_label_width;
    for (const Plot& p : plots) {
        const Axes axes(p, {});
        for (double t : axes.y_ticks(y_ticks_of(terminal)))
            label_width = std::max(label_width, length(axes.y_tick_label(t)));
    }
    const int left = label_width + 2, label = longest_label(plots);
    return {left, std::max(terminal.width - 1 - left - (label > 0 ? label + 1 : 0), min_width)};
}

/// Axis with ticks, the numbers below them, and the label.
std::string abscissa_lines(
    const Range& x, const Layout& layout, const std::string& label, bool ascii) {
    const auto [left, width] = layout;
    std::string axis, numbers(static_cast<std::size_t>(left + width), ' ');
    std::map<int, std::string> at;
    for (double t : ticks(x, std::max(width / 12, 2)))
        at[static_cast<int>(std::lround((t - x.first) / (x.second - x.first) * (width - 1)))] =
            tick_label(t);
    for (int column = 0; column < width; ++column)
        axis += at.contains(column) ? (ascii ? "+" : "┬") : (ascii ? "-" : "─");
    int free = 0;
    for (const auto& [column, number] : at) {
        const int size = length(number), from = left + column - size / 2;
        if (from < free || from + size > left + width) continue;
        numbers.replace(static_cast<std::size_t>(from), static_cast<std::size_t>(size), number);
        free = from + size + 1;
    }
    numbers.erase(numbers.find_last_not_of(' ') + 1);
    const int indent = std::max(left + (width - length(label)) / 2, 0);
    return std::string(static_cast<std::size_t>(left - 1), ' ') + (ascii ? "+" : "└") + axis +
           "\n" + numbers + "\n" + std::string(static_cast<std::size_t>(indent), ' ') + label +
           "\n";
}

}  // namespace

std::string text(const std::vector<Plot>& plots, const Terminal& terminal) {
    const Range x = x_range(plots);
    const Layout layout = layout_of(plots, terminal);
    std::string out;
    for (const Plot& p : plots) out += TextPlot(p, x, layout, terminal).draw();
    if (!plots.empty()) out += abscissa_lines(x, layout, plots.back().x_label, terminal.ascii);
    return out;
}

}  // namespace vines::plot
