#include "core/measurement/missed_impact.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// Samples are averaged to so many points: a kink that is found is placed by the joint fit.
constexpr std::size_t most_kink_points = 240, fewest_kink_points = 10;
// So many of them lie on either side of a kink.
constexpr std::size_t points_beside_kink = 3;
// Of n points in units of their noise: white noise leaves n +- sqrt(2 n), and noise that was
// estimated from few samples a little more. An interval that leaves no more is not searched.
double unsuspicious(std::size_t n) { return 1.3 * static_cast<double>(n) + 10; }
// A kink explains so many variances, and more than that share of what is left: what is odd in
// another way is none.
constexpr double kink_improvement = 49, kink_share = 0.3;

/// Averages of samples.
struct KinkPoint {
    double tau, value, weight;  ///< weight: one over the standard deviation
};

std::vector<KinkPoint> points_of(const IntervalSamples& in) {
    std::vector<KinkPoint> all;
    const auto sample = [&](double tau) {
        return static_cast<std::size_t>(
            std::lower_bound(in.tau.begin(), in.tau.end(), tau + in.late) - in.tau.begin());
    };
    std::size_t k = sample(in.from);
    const std::size_t end = sample(in.to);
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
        sum.tau += in.tau[k] - in.late, sum.value += in.value[k], sum.weight += 1;
        if (sum.weight >= static_cast<double>(together)) close();
    }
    close();
    return all;
}

/// What a motion without a kink may be: the two free ones from the start of the interval, then, if
/// it is asked for, those that a forcing makes, and an offset.
class Basis {
public:
    static constexpr Eigen::Index most = 5;
    using Row = Eigen::Matrix<double, most, 1>;

    Basis(const Flow& flow, double start, bool own_forcing)
        : flow_(flow),
          start_(start),
          own_forcing_(own_forcing) {}

    Row at(double tau) const {
        const double s = std::max(0.0, tau - start_);
        const Transfer t = flow_.transfer(s);
        Row row = Row::Zero();
        row(0) = t.a22, row(1) = t.a21;
        if (!own_forcing_) return row;
        row(2) = flow_.after({0, 0, 0, 1}, s).x, row(3) = flow_.after({0, 0, 1, 0}, s).x;
        row(4) = 1;
        return row;
    }
    /// The free motion with x = 0 and x' = 1 at tau, by the first two; the determinant is theirs of
    /// Wronski.
    Eigen::Vector2d kink(double tau) const {
        const Transfer t = flow_.transfer(std::max(0.0, tau - start_));
        return Eigen::Vector2d(-t.a21, t.a22) / (t.a22 * t.a11 - t.a12 * t.a21);
    }
    Eigen::Index columns() const { return own_forcing_ ? most : 2; }

private:
    const Flow& flow_;
    const double start_;
    const bool own_forcing_;
};

/// Of all points from one on: sums of products of the basis with its first two, and with x.
struct SumsBehind {
    Eigen::Matrix<double, Basis::most, 2> N = Eigen::Matrix<double, Basis::most, 2>::Zero();
    Eigen::Vector2d g = Eigen::Vector2d::Zero();
};

}  // namespace

std::optional<MissedImpact> missed_impact(
    const IntervalSamples& in, const Flow& flow, bool own_forcing) {
    const std::vector<KinkPoint> points = points_of(in);
    if (points.size() < fewest_kink_points + (own_forcing ? 2 * points_beside_kink : 0))
        return std::nullopt;
    const Basis basis(flow, in.from, own_forcing);
    const Eigen::Index columns = basis.columns();
    Eigen::MatrixXd N = Eigen::MatrixXd::Zero(columns, columns);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(columns);
    std::vector<SumsBehind> behind(points.size() + 1);
    double squares = 0;
    for (std::size_t k = points.size(); k-- > 0;) {
        const KinkPoint& p = points[k];
        const Basis::Row row = basis.at(p.tau) * p.weight;
        const double value = p.value * p.weight;
        behind[k].N = behind[k + 1].N + row * row.head<2>().transpose();
        behind[k].g = behind[k + 1].g + row.head<2>() * value;
        N += row.head(columns) * row.head(columns).transpose();
        g += row.head(columns) * value;
        squares += value * value;
    }
    // Columns of one size: the forcing's are far smaller in a short interval.
    const Eigen::VectorXd size = N.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
    const Eigen::LDLT<Eigen::MatrixXd> whole(size.asDiagonal() * N * size.asDiagonal());
    const auto solve = [&](const Eigen::VectorXd& right) -> Eigen::VectorXd {
        return size.asDiagonal() * whole.solve(size.asDiagonal() * right);
    };
    const Eigen::VectorXd own = solve(g);
    const double misfit = squares - g.dot(own);
    if (!(misfit > unsuspicious(points.size()))) return std::nullopt;
    MissedImpact best{0, 0, 0};
    for (std::size_t c = points_beside_kink; c + points_beside_kink < points.size(); ++c) {
        const double tau = 0.5 * (points[c].tau + points[c - 1].tau);
        const Eigen::Vector2d kink = basis.kink(tau);
        const Eigen::VectorXd mixed = behind[c].N.topRows(columns) * kink;
        const double weight = kink.dot(mixed.head<2>()) - mixed.dot(solve(mixed)),
                     along = kink.dot(behind[c].g) - mixed.dot(own);
        const double improvement = along * along / weight;
        if (weight > 0 && improvement > best.improvement) best = {tau, along / weight, improvement};
    }
    if (!(best.improvement > kink_improvement && best.improvement > kink_share * misfit))
        return std::nullopt;
    return best;
}

}  // namespace vines
