#include "core/identification/kinks.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <optional>

#include "core/identification/oscillator_model.hpp"

namespace vines {

namespace {

// A kink is looked for in so many samples of an interval at once, and in no fewer.
constexpr std::size_t kink_window = 400, fewest_kink_samples = 12;
// So many of them lie on either side of it.
constexpr std::size_t samples_beside_kink = 3;
// Of n samples in units of the noise: white noise leaves n +- sqrt(2 n), and noise that was
// estimated from few samples a little more. An interval that leaves no more than this is not
// searched.
double unsuspicious_misfit(std::size_t n) { return 1.3 * static_cast<double>(n) + 10; }

/// Samples [first, first + count) of the record, which lie in one interval.
struct KinkWindow {
    std::size_t first, count;
};

KinkWindow window_of(const MeasuredRecord& r, double begin, double end) {
    const auto from = std::lower_bound(r.tau.begin(), r.tau.end(), begin),
               to = std::upper_bound(r.tau.begin(), r.tau.end(), end);
    const auto first = static_cast<std::size_t>(from - r.tau.begin());
    return {first, std::min(static_cast<std::size_t>(to - r.tau.begin()) - first, kink_window)};
}

/// What is left of x in units of its noise, and what of it a start of its own for these samples
/// (two columns) and a jump of x' (the third) explain.
struct KinkFit {
    Eigen::MatrixXd rows;
    Eigen::VectorXd residual;

    struct Solution {
        double misfit;  ///< sum of squares that remains
        Eigen::VectorXd z;
    };
    Solution solve(Eigen::Index columns) const {
        const Eigen::MatrixXd used = rows.leftCols(columns);
        Eigen::VectorXd z = (used.transpose() * used).ldlt().solve(used.transpose() * residual);
        const double misfit = (residual - used * z).squaredNorm();
        return {misfit, std::move(z)};
    }
};

KinkFit kink_fit(
    const OscillatorModel& model, const MeasuredRecord& r, const FittedMotion& m, std::size_t i,
    const KinkWindow& w, double noise) {
    KinkFit fit{Eigen::MatrixXd(w.count, 3), Eigen::VectorXd(w.count)};
    const Eigen::Vector4d own(m.own_x[i], m.own_x_dot[i], m.force_sin, m.force_cos);
    OscillatorModel::Interval interval(model, m.tau[i]);
    for (std::size_t k = 0; k < w.count; ++k) {
        const auto row = static_cast<Eigen::Index>(k);
        const ModelRows at = interval.at(r.tau[w.first + k] - m.tau[i]);
        fit.rows.block<1, 2>(row, 0) = at.x.head<2>().transpose() / noise;
        fit.residual(row) = (r.x[w.first + k] - at.x.dot(own)) / noise;
    }
    return fit;
}

std::optional<Spike> find_kink(
    const OscillatorModel& model, const MeasuredRecord& r, const FittedMotion& m, std::size_t i,
    double noise) {
    const KinkWindow w = window_of(r, m.tau[i], i + 1 < m.tau.size() ? m.tau[i + 1] : r.tau.back());
    if (w.count < fewest_kink_samples) return std::nullopt;
    KinkFit fit = kink_fit(model, r, m, i, w, noise);
    const double without_kink = fit.solve(2).misfit;
    if (without_kink < unsuspicious_misfit(w.count)) return std::nullopt;
    double least = without_kink, where = 0, jump = 0;
    for (std::size_t c = samples_beside_kink; c + samples_beside_kink < w.count; ++c) {
        const double tau = 0.5 * (r.tau[w.first + c] + r.tau[w.first + c - 1]);
        for (std::size_t k = 0; k < w.count; ++k) {
            const double s = r.tau[w.first + k] - tau;
            fit.rows(static_cast<Eigen::Index>(k), 2) =
                s > 0 ? model.velocity_response(s) / noise : 0;
        }
        const KinkFit::Solution with_kink = fit.solve(3);
        if (with_kink.misfit < least) least = with_kink.misfit, where = tau, jump = with_kink.z(2);
    }
    if (!(without_kink - least > kink_sigmas * kink_sigmas)) return std::nullopt;
    return Spike{where, jump > 0 ? -1 : 1, jump, 0};
}

}  // namespace

std::vector<Spike> find_kinks(
    const Parameters& p, const MeasuredRecord& r, const FittedMotion& m, double noise,
    IdentificationProgress& progress) {
    const OscillatorModel model(p);
    std::vector<Spike> kinks;
    for (std::size_t i = 0; i < m.tau.size(); ++i) {
        progress.look();
        if (const auto kink = find_kink(model, r, m, i, noise)) kinks.push_back(*kink);
    }
    return kinks;
}

}  // namespace vines
