#include "section_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

namespace vines::hunt {

namespace {

constexpr int most_nodes = 2500, fewest_nodes = 250;
// Longest step of the walk and of its closure, relative to the length of the curve.
constexpr double longest_step = 0.1;
// A smooth curve turns by less than this (cosine) at nearly every node.
constexpr double least_cosine = 0.9;
// Largest fractions of nodes at which the walk turns sharply or the motion changes their order.
constexpr double most_sharp = 0.1, most_disordered = 0.01;

using Point = std::array<double, 4>;

double square_of_distance(const Point& a, const Point& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
}

double along(const Point& from, const Point& to, const Point& from_other, const Point& to_other) {
    double sum = 0;
    for (std::size_t i = 0; i < from.size(); ++i)
        sum += (to[i] - from[i]) * (to_other[i] - from_other[i]);
    return sum;
}

/// Section points of the run: x, x', x - y and y' in units of their ranges, or, if `continuous`,
/// only quantities that are continuous through an impact: x, x' + epsilon y', x - y. With an impact
/// near a whole cycle the former jump.
std::vector<Point> points_of(const Parameters& p, const LongRun& run, bool continuous) {
    std::vector<Point> points;
    Point low, high;
    low.fill(INFINITY), high.fill(-INFINITY);
    for (int k = 0; k <= run.cycles(); ++k) {
        const State& s = run.at_cycle(k);
        points.push_back(
            continuous ? Point{s.x, s.x_dot + p.epsilon * s.y_dot, s.x - s.y, 0}
                       : Point{s.x, s.x_dot, s.x - s.y, s.y_dot});
        if (k < run.cycles() / 2) continue;
        for (std::size_t i = 0; i < low.size(); ++i) {
            low[i] = std::min(low[i], points.back()[i]);
            high[i] = std::max(high[i], points.back()[i]);
        }
    }
    for (Point& point : points)
        for (std::size_t i = 0; i < low.size(); ++i)
            point[i] = high[i] > low[i] ? point[i] / (high[i] - low[i]) : 0;
    return points;
}

/// Closed walk through nodes, each step to the nearest node ahead that is not visited yet.
class Walk {
public:
    explicit Walk(std::vector<Point> nodes) : nodes_(std::move(nodes)), rank_(nodes_.size()) {
        std::vector<int> left(nodes_.size() - 1);
        std::iota(left.begin(), left.end(), 1);
        order_.push_back(0);
        while (!left.empty()) {
            const Point& here = nodes_[static_cast<std::size_t>(order_.back())];
            const Point* const before =
                order_.size() > 1 ? &nodes_[static_cast<std::size_t>(order_[order_.size() - 2])]
                                  : nullptr;
            std::size_t next = left.size();
            double nearest = INFINITY;
            for (std::size_t i = 0; i < left.size(); ++i) {
                const Point& there = nodes_[static_cast<std::size_t>(left[i])];
                const double square = square_of_distance(here, there);
                if (square < nearest && (!before || along(*before, here, here, there) > 0))
                    nearest = square, next = i;
            }
            if (next == left.size()) return;
            order_.push_back(left[next]);
            left[next] = left.back();
            left.pop_back();
        }
        position_.push_back(0);
        for (std::size_t i = 0; i < order_.size(); ++i) {
            rank_[static_cast<std::size_t>(order_[i])] = i;
            position_.push_back(
                position_.back() + std::sqrt(square_of_distance(node(i), node(i + 1))));
        }
    }

    /// True if all nodes are visited in short steps with few sharp turns.
    bool is_smooth() const {
        if (order_.size() < nodes_.size()) return false;
        std::size_t sharp = 0;
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const double step = position_[i + 1] - position_[i],
                         next = std::sqrt(square_of_distance(node(i + 1), node(i + 2)));
            if (step > longest_step * length()) return false;
            sharp +=
                along(node(i), node(i + 1), node(i + 1), node(i + 2)) < least_cosine * step * next;
        }
        return static_cast<double>(sharp) < most_sharp * static_cast<double>(order_.size());
    }

    /// True if the motion from each node to the next in time keeps their cyclic order.
    bool keeps_order() const {
        const auto n = static_cast<long>(order_.size());
        long turns_of_ranks = 0, before = -1, first = -1;
        for (const int k : order_) {
            if (k + 1 == n) continue;
            const auto image = static_cast<long>(rank_[static_cast<std::size_t>(k) + 1]);
            if (before >= 0) turns_of_ranks += (image - before + n) % n;
            if (first < 0) first = image;
            before = image;
        }
        turns_of_ranks += (first - before + n) % n;
        return static_cast<double>(turns_of_ranks / n - 1) <
               most_disordered * static_cast<double>(n);
    }

    /// Position of a point along the curve, in turns, and its distance from it.
    struct Place {
        double turns, distance;
    };
    Place place(const Point& point) const {
        std::size_t nearest = 0;
        double square = INFINITY;
        for (std::size_t i = 0; i < order_.size(); ++i)
            if (const double d = square_of_distance(point, node(i)); d < square)
                square = d, nearest = i;
        Place best{position_[nearest] / length(), std::sqrt(square)};
        for (const std::size_t from : {nearest, nearest + order_.size() - 1}) {
            const Point &a = node(from), &b = node(from + 1);
            const double whole = square_of_distance(a, b),
                         part = whole > 0 ? along(a, b, a, point) / whole : 0;
            if (!(part >= 0 && part <= 1)) continue;
            Point foot;
            for (std::size_t i = 0; i < foot.size(); ++i) foot[i] = a[i] + part * (b[i] - a[i]);
            const double distance = std::sqrt(square_of_distance(point, foot));
            if (distance <= best.distance)
                best = {
                    (position_[from % order_.size()] + part * std::sqrt(whole)) / length(),
                    distance};
        }
        return best;
    }
    double length() const { return position_.back(); }

private:
    const Point& node(std::size_t i) const {
        return nodes_[static_cast<std::size_t>(order_[i % order_.size()])];
    }

    std::vector<Point> nodes_;
    std::vector<int> order_;
    std::vector<std::size_t> rank_;
    std::vector<double> position_;  // of order_[i], and the length of the curve
};

/// Weighted Birkhoff average: smooth weights that vanish with all derivatives at both ends.
double weighted_mean(const std::vector<double>& values, std::size_t from, std::size_t to) {
    double sum = 0, weights = 0;
    for (std::size_t k = from; k < to; ++k) {
        const double t = (static_cast<double>(k - from) + 1) / (static_cast<double>(to - from) + 1),
                     weight = std::exp(-1 / (t * (1 - t)));
        sum += weight * values[k], weights += weight;
    }
    return sum / weights;
}

/// Increments of positions modulo 1, cut in the largest gap between them, where no increment of an
/// order-preserving map lies.
std::vector<double> increments(const std::vector<double>& turns) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < turns.size(); ++k) {
        const double step = turns[k] - turns[k - 1];
        steps.push_back(step - std::floor(step));
    }
    std::vector<double> sorted = steps;
    std::ranges::sort(sorted);
    double cut = sorted.front(), gap = sorted.front() + 1 - sorted.back();
    for (std::size_t k = 1; k < sorted.size(); ++k)
        if (sorted[k] - sorted[k - 1] > gap) gap = sorted[k] - sorted[k - 1], cut = sorted[k];
    for (double& step : steps)
        if (step < cut) step += 1;
    return steps;
}

std::optional<SectionCurve> on_curves(const std::vector<Point>& points, int curves, int from) {
    const auto apart = static_cast<std::size_t>(curves);
    std::vector<Point> of_one;
    for (std::size_t k = points.size() % apart; k < points.size(); k += apart)
        if (k >= static_cast<std::size_t>(from)) of_one.push_back(points[k]);
    if (of_one.size() < fewest_nodes) return std::nullopt;
    const std::size_t nodes = std::min<std::size_t>(of_one.size(), most_nodes);
    const Walk walk(std::vector<Point>(of_one.end() - static_cast<long>(nodes), of_one.end()));
    if (!walk.is_smooth() || !walk.keeps_order()) return std::nullopt;
    SectionCurve found{curves, 0, 0, 0};
    std::vector<double> turns;
    for (const Point& point : of_one) {
        const auto place = walk.place(point);
        turns.push_back(place.turns);
        found.farthest = std::max(found.farthest, place.distance);
    }
    const std::vector<double> steps = increments(turns);
    const std::size_t n = steps.size();
    found.rotation = weighted_mean(steps, 0, n);
    found.rotation -= std::round(found.rotation);
    found.error = std::abs(weighted_mean(steps, 0, n / 2) - weighted_mean(steps, n / 2, n));
    return found;
}

}  // namespace

std::optional<SectionCurve> section_curve(
    const Parameters& p, const LongRun& run, int from, int most_curves) {
    const std::vector<Point> all = points_of(p, run, false), continuous = points_of(p, run, true);
    for (int curves = 1; curves <= most_curves; ++curves)
        for (const auto* points : {&all, &continuous})
            if (auto found = on_curves(*points, curves, from)) return found;
    return std::nullopt;
}

}  // namespace vines::hunt
