#include "plot/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>

namespace vines::plot {

namespace {

constexpr const char* grid = R"(stroke="#e4e7ea")";
constexpr const char* level_line = R"(stroke="#8a939b")";
constexpr double far = 1e5;  // px, beyond any frame
constexpr const char* time_line = R"(stroke="#b3261e" stroke-dasharray="6 4")";

std::string escaped(const std::string& text) {
    std::string out;
    for (char c : text)
        out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return out;
}

/// stroke-dasharray attribute with a leading space, or nothing.
std::string dashed(const Curve& c) {
    return c.dash.empty() ? "" : fmt::format(R"( stroke-dasharray="{}")", c.dash);
}

class SvgPlot : Axes {
public:
    SvgPlot(const Plot& of, const Range& x, int width, int height, int top)
        : Axes(of, x),
          left_(62),
          right_(width - 12),
          legend_(top + (plot.title.empty() ? 4 : 22)),
          top_(legend_ + (is_labelled() ? 20 : 6)),
          bottom_(top + height - 38) {}

    std::string draw() {
        shade_bands();
        draw_grid();
        mark_levels_and_times();
        frame();
        for (const Curve& c : plot.curves) {
            c.dots ? dots(c) : line(c);
            arrows(c);
        }
        legend();
        if (!plot.title.empty()) text(left_, legend_ - 2, "start", plot.title);
        return std::move(out_);
    }

private:
    double px(double x) const {
        // Points at the ends of the range keep this distance from the frame.
        constexpr double inset = 6;
        return left_ + inset +
               (x - abscissa.first) / (abscissa.second - abscissa.first) *
                   (right_ - left_ - 2 * inset);
    }
    double py(double v) const {
        return bottom_ -
               (v - ordinate.first) / (ordinate.second - ordinate.first) * (bottom_ - top_);
    }
    template <class... Values>
    void add(fmt::format_string<Values...> pattern, Values&&... values) {
        fmt::format_to(std::back_inserter(out_), pattern, std::forward<Values>(values)...);
        out_ += '\n';
    }
    void text(
        double x, double y, const char* anchor, const std::string& what,
        const std::string& more = "") {
        add(R"(<text x="{:.1f}" y="{:.1f}" text-anchor="{}"{}>{}</text>)", x, y, anchor, more,
            escaped(what));
    }
    void rule(double x1, double y1, double x2, double y2, const std::string& style) {
        add(R"(<line x1="{:.1f}" y1="{:.1f}" x2="{:.1f}" y2="{:.1f}" {}/>)", x1, y1, x2, y2, style);
    }
    void box(double x, double y, double width, double height, const char* style) {
        add(R"(<rect x="{:.1f}" y="{:.1f}" width="{:.1f}" height="{:.1f}" {}/>)", x, y, width,
            height, style);
    }
    void dot(double x, double y, const char* radius, const std::string& colour) {
        add(R"(<circle cx="{:.1f}" cy="{:.1f}" r="{}" fill="{}"/>)", x, y, radius, colour);
    }

    void shade_bands() {
        for (const auto& [from, to] : plot.bands) {
            const double a = std::max(px(from), left_), b = std::min(px(to), right_);
            if (b > a)
                box(a, top_, std::max(b - a, 0.5), bottom_ - top_,
                    R"(fill="#2e8b57" fill-opacity=".16")");
        }
    }

    void draw_grid() {
        for (double t : ticks(abscissa, 8)) {
            rule(px(t), top_, px(t), bottom_, grid);
            text(px(t), bottom_ + 15, "middle", tick_label(t));
        }
        for (double t : y_ticks(plot.logarithmic ? 4 : 5)) {
            rule(left_, py(t), right_, py(t), grid);
            text(left_ - 6, py(t) + 4, "end", y_tick_label(t));
        }
    }

    void mark_levels_and_times() {
        for (double level : plot.levels)
            if (contain(abscissa.first, value(level)))
                rule(left_, py(value(level)), right_, py(value(level)), level_line);
        for (double m : plot.marked_times)
            if (m >= abscissa.first && m <= abscissa.second)
                rule(px(m), top_, px(m), bottom_, time_line);
    }

    void frame() {
        box(left_, top_, right_ - left_, bottom_ - top_, R"(fill="none" stroke="#b9c0c6")");
        text(0.5 * (left_ + right_), bottom_ + 31, "middle", plot.x_label);
        const double middle = 0.5 * (top_ + bottom_);
        text(
            14, middle, "middle", plot.y_label,
            fmt::format(" transform=\"rotate(-90 14 {:.1f})\"", middle));
    }

    void polyline(const Curve& c, const std::string& points) {
        if (points.empty()) return;
        add(R"(<polyline fill="none" stroke="{}" stroke-width="1.1"{} points="{}"/>)", c.colour,
            dashed(c), points);
    }

    void line(const Curve& c) {
        // A nested <svg> clips its content, here to the frame.
        add(R"(<svg x="{0:.1f}" y="{1:.1f}" width="{2:.1f}" height="{3:.1f}" )"
            R"(viewBox="{0:.1f} {1:.1f} {2:.1f} {3:.1f}">)",
            left_, top_, right_ - left_, bottom_ - top_);
        std::string points;
        // First, lowest, highest and last point of each half pixel give the same picture.
        for (std::size_t i = 0; i < c.x.size();) {
            if (!std::isfinite(value(c.y[i]))) {
                polyline(c, points);
                points.clear();
                ++i;
                continue;
            }
            const double column = std::floor(2 * px(c.x[i]));
            std::size_t low = i, high = i, last = i;
            for (std::size_t k = i; k < c.x.size() && std::floor(2 * px(c.x[k])) == column &&
                                    std::isfinite(value(c.y[k]));
                 last = k++) {
                if (c.y[k] < c.y[low]) low = k;
                if (c.y[k] > c.y[high]) high = k;
            }
            for (const std::size_t k : std::set{i, low, high, last})
                fmt::format_to(
                    std::back_inserter(points), "{:.1f},{:.1f} ", px(c.x[k]),
                    std::clamp(py(value(c.y[k])), -far, far));
            i = last + 1;
        }
        polyline(c, points);
        out_ += "</svg>\n";
    }

    /// Triangles on the frame where a curve leaves the range of the ordinate.
    void arrows(const Curve& c) {
        constexpr double width = 8;
        double free_from[2] = {left_, left_};  // of the lower and the upper edge
        int before = 0;
        for (std::size_t i = 0; i < c.x.size(); ++i) {
            const double v = value(c.y[i]), x = px(c.x[i]);
            const int side = !std::isfinite(v) ? 0 : (v > ordinate.second) - (v < ordinate.first);
            double& free = free_from[side > 0];
            if (side != 0 && side != before && x >= free) {
                add(R"(<path d="M{:.1f},{:.1f}h{}l{},{}z" fill="{}"/>)", x - width / 2,
                    side > 0 ? top_ + width : bottom_ - width, width, -width / 2, -side * width,
                    c.colour);
                free = x + width;
            }
            before = side;
        }
    }

    void dots(const Curve& c) {
        const char* const radius = c.x.size() > 100 ? "1.3" : "3";
        for (std::size_t i = 0; i < c.x.size(); ++i) {
            const double x = px(c.x[i]), v = value(c.y[i]);
            if (!contain(c.x[i], v)) continue;
            const auto [low, high] = error_bar(c, i);
            if (!c.error.empty())
                rule(
                    x, py(std::max(low, ordinate.first)), x, py(std::min(high, ordinate.second)),
                    fmt::format(R"(stroke="{}")", c.colour));
            dot(x, py(v), radius, c.colour);
        }
    }

    bool is_labelled() const {
        return std::ranges::any_of(plot.curves, [](const Curve& c) { return !c.label.empty(); });
    }

    /// Above the frame, where no curve is.
    void legend() {
        double x = left_;
        for (const Curve& c : plot.curves) {
            if (c.label.empty()) continue;
            if (c.dots) dot(x + 7, legend_ + 8, "3", c.colour);
            else
                rule(
                    x, legend_ + 8, x + 14, legend_ + 8,
                    fmt::format(R"(stroke="{}" stroke-width="2"{})", c.colour, dashed(c)));
            text(x + 18, legend_ + 12, "start", c.label);
            x += 30 + 6.3 * static_cast<double>(c.label.size());
        }
    }

    const double left_, right_, legend_, top_, bottom_;
    std::string out_;
};

}  // namespace

std::string svg(const std::vector<Plot>& plots, int width, int height) {
    const int total = height * static_cast<int>(plots.size());
    const Range x = x_range(plots);
    std::string out = fmt::format(
        R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {0} {1}" width="{0}" height="{1}" )"
        R"(font-family="system-ui, sans-serif" font-size="11.5" fill="#39424a">)"
        "\n"
        R"(<rect width="100%" height="100%" fill="#fff"/>)"
        "\n",
        width, total);
    for (std::size_t i = 0; i < plots.size(); ++i)
        out += SvgPlot(plots[i], x, width, height, height * static_cast<int>(i)).draw();
    return out + "</svg>\n";
}

}  // namespace vines::plot
