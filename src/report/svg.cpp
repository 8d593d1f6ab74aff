#include "report/svg.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace vines::report {

namespace {

std::string format(const char* pattern, double value) {
    char text[48];
    std::snprintf(text, sizeof text, pattern, value);
    return text;
}
std::string pixel(double v) { return format("%.1f", v); }

std::string escaped(const std::string& text) {
    std::string out;
    for (char c : text)
        out += c == '<' ? "&lt;" : c == '>' ? "&gt;" : c == '&' ? "&amp;" : std::string(1, c);
    return out;
}

using Range = std::pair<double, double>;

/// Steps of 1, 2 or 5 times a power of ten, about `count` of them.
std::vector<double> ticks(const Range& r, int count) {
    const double raw = (r.second - r.first) / count,
                 power = std::pow(10, std::floor(std::log10(raw)));
    double step = power;
    for (double m : {2., 5., 10.})
        if (step < raw) step = m * power;
    std::vector<double> list;
    for (double k = std::ceil(r.first / step - 1e-9);
         k * step <= r.second * (1 + 1e-12) + 1e-12 * step; ++k)
        list.push_back(k * step);
    return list;
}

Range widened(Range r, double share) {
    const double margin = (r.second - r.first) * share;
    if (!(r.second > r.first)) return {r.first - 0.5, r.first + 0.5};
    return {r.first - margin, r.second + margin};
}

/// Of all curves of all plots: they share their abscissa.
Range x_range(const std::vector<Plot>& plots) {
    Range x{1e300, -1e300};
    bool dots = false;
    for (const Plot& p : plots) {
        for (const Curve& c : p.curves) {
            dots = dots || (c.dots && !c.error.empty());
            for (double v : c.x) x = {std::min(x.first, v), std::max(x.second, v)};
        }
    }
    if (x.first > x.second) return {0, 1};
    return widened(x, dots ? 0.03 : 0);
}

class Canvas {
public:
    Canvas(const Plot& plot, const Range& x, int width, int height, int top)
        : plot_(plot),
          left_(62),
          right_(width - 12),
          top_(top + 10),
          bottom_(top + height - 38) {
        Range y{1e300, -1e300};
        for (const Curve& c : plot.curves) {
            for (std::size_t i = 0; i < c.x.size(); ++i) {
                const double v = value(c.y[i]), e = c.error.empty() ? 0 : c.error[i];
                if (std::isfinite(v)) y = {std::min(y.first, v - e), std::max(y.second, v + e)};
            }
        }
        if (y.first > y.second) y = {0, 1};
        x_ = x;
        y_ = plot.y_range ? Range{value(plot.y_range->first), value(plot.y_range->second)}
                          : widened(y, 0.06);
    }

    std::string draw() {
        frame();
        for (const Curve& c : plot_.curves) c.dots ? dots(c) : line(c);
        legend();
        return std::move(out_);
    }

private:
    double value(double y) const { return plot_.logarithmic ? std::log10(y) : y; }
    double px(double x) const {
        return left_ + (x - x_.first) / (x_.second - x_.first) * (right_ - left_);
    }
    double py(double v) const {
        return bottom_ - (v - y_.first) / (y_.second - y_.first) * (bottom_ - top_);
    }
    bool inside(double x, double v) const {
        return x >= x_.first && x <= x_.second && v >= y_.first && v <= y_.second;
    }

    void text(
        double x, double y, const std::string& anchor, const std::string& what,
        const std::string& more = "") {
        out_ += "<text x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" text-anchor=\"" + anchor +
                "\"" + more + ">" + escaped(what) + "</text>\n";
    }
    void rule(double x1, double y1, double x2, double y2, const std::string& style) {
        out_ += "<line x1=\"" + pixel(x1) + "\" y1=\"" + pixel(y1) + "\" x2=\"" + pixel(x2) +
                "\" y2=\"" + pixel(y2) + "\" " + style + "/>\n";
    }

    void frame() {
        for (const auto& [from, to] : plot_.bands) {
            const double a = std::max(px(from), double(left_)),
                         b = std::min(px(to), double(right_));
            if (b > a)
                out_ += "<rect x=\"" + pixel(a) + "\" y=\"" + pixel(top_) + "\" width=\"" +
                        pixel(std::max(b - a, 0.5)) + "\" height=\"" + pixel(bottom_ - top_) +
                        "\" fill=\"#2e8b57\" fill-opacity=\".16\"/>\n";
        }
        for (double t : ticks(x_, 8)) {
            rule(px(t), top_, px(t), bottom_, "stroke=\"#e4e7ea\"");
            text(px(t), bottom_ + 15, "middle", format("%g", std::abs(t) < 1e-12 ? 0 : t));
        }
        for (double t : ticks(y_, plot_.logarithmic ? 4 : 5)) {
            if (plot_.logarithmic && t != std::floor(t)) continue;
            rule(left_, py(t), right_, py(t), "stroke=\"#e4e7ea\"");
            text(
                left_ - 6, py(t) + 4, "end",
                (plot_.logarithmic ? "1e" : "") + format("%g", std::abs(t) < 1e-12 ? 0 : t));
        }
        for (double level : plot_.levels)
            if (inside(x_.first, value(level)))
                rule(left_, py(value(level)), right_, py(value(level)), "stroke=\"#8a939b\"");
        for (double m : plot_.moments)
            if (m >= x_.first && m <= x_.second)
                rule(px(m), top_, px(m), bottom_, "stroke=\"#b3261e\" stroke-dasharray=\"6 4\"");
        out_ += "<rect x=\"" + pixel(left_) + "\" y=\"" + pixel(top_) + "\" width=\"" +
                pixel(right_ - left_) + "\" height=\"" + pixel(bottom_ - top_) +
                "\" fill=\"none\" stroke=\"#b9c0c6\"/>\n";
        text(0.5 * (left_ + right_), bottom_ + 31, "middle", plot_.x_label);
        const double middle = 0.5 * (top_ + bottom_);
        text(
            14, middle, "middle", plot_.y_label,
            " transform=\"rotate(-90 14 " + pixel(middle) + ")\"");
    }

    void line(const Curve& c) {
        std::string points;
        auto flush = [&] {
            if (!points.empty())
                out_ += "<polyline fill=\"none\" stroke=\"" + c.colour + "\" stroke-width=\"1.1\"" +
                        (c.dash.empty() ? "" : " stroke-dasharray=\"" + c.dash + "\"") +
                        " points=\"" + points + "\"/>\n";
            points.clear();
        };
        // Of all points in one column of half a pixel the first, the lowest, the highest and the
        // last: the same picture.
        for (std::size_t i = 0; i < c.x.size();) {
            if (!std::isfinite(value(c.y[i]))) {
                flush();
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
            std::size_t wanted[] = {i, std::min(low, high), std::max(low, high), last};
            const auto end = std::unique(std::begin(wanted), std::end(wanted));
            for (auto k = std::begin(wanted); k != end; ++k)
                points += pixel(px(c.x[*k])) + "," +
                          pixel(std::clamp(py(value(c.y[*k])), top_ - 1.0, bottom_ + 1.0)) + " ";
            i = last + 1;
        }
        flush();
    }

    void dots(const Curve& c) {
        for (std::size_t i = 0; i < c.x.size(); ++i) {
            const double v = value(c.y[i]);
            if (!std::isfinite(v) || !inside(c.x[i], v)) continue;
            if (!c.error.empty())
                rule(
                    px(c.x[i]), py(v - c.error[i]), px(c.x[i]), py(v + c.error[i]),
                    "stroke=\"" + c.colour + "\"");
            out_ += "<circle cx=\"" + pixel(px(c.x[i])) + "\" cy=\"" + pixel(py(v)) + "\" r=\"" +
                    (c.x.size() > 100 ? "1.3" : "3") + "\" fill=\"" + c.colour + "\"/>\n";
        }
    }

    void legend() {
        double x = left_ + 8;
        for (const Curve& c : plot_.curves) {
            if (c.label.empty()) continue;
            // Behind the words, so that they can be read over curves.
            const double width = 26 + 6.3 * static_cast<double>(c.label.size());
            out_ += "<rect x=\"" + pixel(x - 3) + "\" y=\"" + pixel(top_ + 3) + "\" width=\"" +
                    pixel(width) + "\" height=\"16\" fill=\"#fff\" fill-opacity=\".8\"/>\n";
            if (c.dots)
                out_ += "<circle cx=\"" + pixel(x + 7) + "\" cy=\"" + pixel(top_ + 11) +
                        "\" r=\"3\" fill=\"" + c.colour + "\"/>\n";
            else
                rule(
                    x, top_ + 11, x + 14, top_ + 11,
                    "stroke=\"" + c.colour + "\" stroke-width=\"2\"" +
                        (c.dash.empty() ? "" : " stroke-dasharray=\"" + c.dash + "\""));
            text(x + 18, top_ + 15, "start", c.label);
            x += width + 4;
        }
    }

    const Plot& plot_;
    const double left_, right_, top_, bottom_;
    Range x_, y_;
    std::string out_;
};

}  // namespace

std::string svg(const std::vector<Plot>& plots, int width, int height) {
    const int total = height * static_cast<int>(plots.size());
    const Range x = x_range(plots);
    std::string out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " +
                      std::to_string(width) + " " + std::to_string(total) + "\" width=\"" +
                      std::to_string(width) + "\" height=\"" + std::to_string(total) +
                      "\" font-family=\"system-ui, sans-serif\" font-size=\"11.5\" "
                      "fill=\"#39424a\">\n<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
    for (std::size_t i = 0; i < plots.size(); ++i)
        out += Canvas(plots[i], x, width, height, height * static_cast<int>(i)).draw();
    return out + "</svg>\n";
}

}  // namespace vines::report
