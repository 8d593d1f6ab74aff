// Impacts in a displacement: kinks, where its slope jumps.
//
// One motion is fitted to an interval by least squares; then a kink is tried between all
// neighbouring points, with shared sums over the later points. The kink that reduces the sum of
// squares most is accepted if the reduction is significant.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/measurement/search.hpp"

namespace vines {

namespace {

// Samples are averaged to this many points; the joint fit refines the time of a kink.
constexpr std::size_t most_kink_points = 240, fewest_kink_points = 10;
constexpr std::size_t points_beside_kink = 3;  // fewest points on either side of a kink
// Sum of squares of n points, in variances, below which an interval is not searched: white noise
// yields n +- sqrt(2 n), and a little more if estimated from few samples.
double unsuspicious(std::size_t n) { return 1.3 * static_cast<double>(n) + 10; }
// A kink must explain this many variances, and this fraction of the residual.
constexpr double kink_improvement = 49, kink_share = 0.3;

/// Average of consecutive samples.
struct KinkPoint {
    double tau, value, weight;  ///< weight: one over the standard deviation
};

std::vector<KinkPoint> points_of(const IntervalSamples& in) {
    std::vector<KinkPoint> all;
    std::size_t k = first_index(in.record, in.from + in.late);
    const std::size_t end = first_index(in.record, in.to + in.late);
    if (end <= k) return all;
    const std::size_t together = 1 + (end - k) / most_kink_points;
    KinkPoint sum{0, 0, 0};
    const auto close = [&] {
        if (sum.weight > 0)
            all.push_back(
                {sum.tau / sum.weight, sum.value / sum.weight, std::sqrt(sum.weight) / in.noise});
        sum = {0, 0, 0};
    };
    for (; k < end; ++k) {
        if (in.bad[k]) continue;
        sum.tau += in.record.tau[k] - in.late, sum.value += in.value[k], sum.weight += 1;
        if (sum.weight >= static_cast<double>(together)) close();
    }
    close();
    return all;
}

/// Basis of a motion without a kink: the two free motions from the start of the interval and, with
/// `own_forcing`, the response to sine and cosine and an offset.
struct SmoothMotionBasis {
    const Flow& flow;
    const double start;
    const bool own_forcing;

    static constexpr Eigen::Index most = 5;
    using Row = Eigen::Matrix<double, most, 1>;

    Row at(double tau) const {
        const double s = std::max(0.0, tau - start);
        const Transfer t = flow.transfer(s);
        Row row = Row::Zero();
        row(0) = t.a22, row(1) = t.a21;
        if (!own_forcing) return row;
        row(2) = flow.after({0, 0, 0, 1}, s).x, row(3) = flow.after({0, 0, 1, 0}, s).x;
        row(4) = 1;
        return row;
    }
    /// Free motion with x = 0 and x' = 1 at tau, as a combination of the first two.
    Eigen::Vector2d kink(double tau) const {
        const Transfer t = flow.transfer(std::max(0.0, tau - start));
        return Eigen::Vector2d(-t.a21, t.a22) / (t.a22 * t.a11 - t.a12 * t.a21);
    }
    Eigen::Index columns() const { return own_forcing ? most : 2; }
};

/// Sums over all later points: products of the basis with its first two functions, and with x.
struct LaterSums {
    Eigen::Matrix<double, SmoothMotionBasis::most, 2> N =
        Eigen::Matrix<double, SmoothMotionBasis::most, 2>::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
};

// Length of a search window, too short for many kinks, and distance between windows, in tau.
constexpr double window = 4, window_hop = 1;
// Each round finds kinks that stronger neighbours concealed.
constexpr int most_rounds_of_kinks = 10;

using TimeSpan = std::pair<double, double>;

void see_in_windows(
    const ImpactSearch& s, const Flow& flow, const TimeSpan& interval, Candidates& seen) {
    const auto [from, to] = interval;
    for (double begin = from; begin < to; begin += window_hop) {
        s.progress.look();
        const double end = std::min(to, begin + window);
        const auto missed = find_kink(
            {s.record, s.record.x, s.statistics.x.bad, s.statistics.x.noise, 0, begin, end}, flow,
            true);
        if (missed) seen.push_back(*missed);
        if (end == to) return;
    }
}

/// Adds the best of kinks near each other; false if there is none.
bool add_best(Candidates seen, Candidates& candidates) {
    std::ranges::sort(seen, std::greater(), &Candidate::improvement);
    std::vector<double> added;  // in order of time
    for (const Candidate& m : seen) {
        const auto after = std::ranges::lower_bound(added, m.tau);
        if ((after != added.end() && *after - m.tau < 0.5 * window) ||
            (after != added.begin() && m.tau - *(after - 1) < 0.5 * window))
            continue;
        added.insert(after, m.tau);
        candidates.push_back(m);
    }
    return !added.empty();
}

/// Intervals between candidates, reduced by the largest delay of the displacement.
std::vector<TimeSpan> intervals_of(const Candidates& candidates, const MeasuredRecord& r) {
    std::vector<TimeSpan> intervals;
    double from = r.tau.front();
    for (const Candidate& c : candidates) {
        intervals.emplace_back(from, c.tau - largest_delay);
        from = c.tau + largest_delay;
    }
    intervals.emplace_back(from, r.tau.back());
    return intervals;
}

}  // namespace

std::optional<Candidate> find_kink(const IntervalSamples& in, const Flow& flow, bool own_forcing) {
    const std::vector<KinkPoint> points = points_of(in);
    if (points.size() < fewest_kink_points + (own_forcing ? 2 * points_beside_kink : 0))
        return std::nullopt;
    const SmoothMotionBasis basis{flow, in.from, own_forcing};
    const Eigen::Index columns = basis.columns();
    Eigen::MatrixXd N = Eigen::MatrixXd::Zero(columns, columns);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(columns);
    std::vector<LaterSums> later(points.size() + 1);
    double squares = 0;
    for (std::size_t k = points.size(); k-- > 0;) {
        const KinkPoint& p = points[k];
        const SmoothMotionBasis::Row row = basis.at(p.tau) * p.weight;
        const double value = p.value * p.weight;
        later[k].N = later[k + 1].N + row * row.head<2>().transpose();
        later[k].g = later[k + 1].g + row.head<2>() * value;
        N += row.head(columns) * row.head(columns).transpose();
        g += row.head(columns) * value;
        squares += value * value;
    }
    // Scales the columns: the forcing's are far smaller in a short interval.
    const Eigen::VectorXd size = N.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    const Eigen::LDLT<Eigen::MatrixXd> whole(size.asDiagonal() * N * size.asDiagonal());
    const auto solve = [&](const Eigen::VectorXd& right) -> Eigen::VectorXd {
        return size.asDiagonal() * whole.solve(size.asDiagonal() * right);
    };
    const Eigen::VectorXd own = solve(g);
    const double misfit = squares - g.dot(own);
    if (!(misfit > unsuspicious(points.size()))) return std::nullopt;
    Candidate best;
    for (std::size_t c = points_beside_kink; c + points_beside_kink < points.size(); ++c) {
        const double tau = 0.5 * (points[c].tau + points[c - 1].tau);
        const Eigen::Vector2d kink = basis.kink(tau);
        const Eigen::VectorXd mixed = later[c].N.topRows(columns) * kink;
        const double weight = kink.dot(mixed.head<2>()) - mixed.dot(solve(mixed)),
                     along = kink.dot(later[c].g) - mixed.dot(own);
        const double improvement = along * along / weight;
        if (weight > 0 && improvement > best.improvement)
            best = {.tau = tau, .jump = along / weight, .improvement = improvement};
    }
    if (!(best.improvement > kink_improvement && best.improvement > kink_share * misfit))
        return std::nullopt;
    return best;
}

void add_kinks(ImpactSearch& s) {
    if (s.record.x.empty()) return;
    const Flow flow(1, 2 * s.parameters.zeta(), 1, s.parameters.Omega);
    std::vector<TimeSpan> looked_at;
    for (int round = 0; round < most_rounds_of_kinks; ++round) {
        std::ranges::sort(s.candidates, {}, &Candidate::tau);
        std::vector<TimeSpan> intervals = intervals_of(s.candidates, s.record);
        Candidates seen;
        for (const TimeSpan& i : intervals)
            if (!std::ranges::binary_search(looked_at, i)) see_in_windows(s, flow, i, seen);
        looked_at = std::move(intervals);
        if (!add_best(std::move(seen), s.candidates)) return;
    }
    std::ranges::sort(s.candidates, {}, &Candidate::tau);
}

}  // namespace vines
