#include "core/measurement/pulse_signal.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/measurement/background.hpp"
#include "core/measurement/robust.hpp"
#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// A stretch holds so many cycles of the oscillator; within it a frequency that is off by .3 % slips
// by .15 rad.
constexpr double stretch_cycles = 8;
// Its weights are fitted so often, each time with those samples weighed less that stand out by
// more than so many deviations.
constexpr int fits = 12;
constexpr double off_motion = 2;
constexpr Eigen::Index columns = 6;
// x' at a sample is a difference over so much on both sides, in tau: what noise it magnifies is
// weighed by how late the displacement is.
constexpr double difference_reach = 0.1;
constexpr std::size_t fewest_samples_of_stretch = 40;

/// Samples [from, to) of a record, and the motion that they show.
class SampledStretch {
public:
    SampledStretch(
        const MeasuredRecord& r, const BadSamples& bad, double Omega, std::size_t from,
        std::size_t to)
        : rows_(static_cast<Eigen::Index>(to - from), columns),
          a_(static_cast<Eigen::Index>(to - from)),
          known_(to - from),
          usable_(to - from) {
        const double middle = 0.5 * (r.tau[from] + r.tau[to - 1]),
                     length = r.tau[to - 1] - r.tau[from];
        std::size_t before = from, after = from;
        for (std::size_t k = from; k < to; ++k) {
            while (r.tau[k] - r.tau[before] > difference_reach && before < k) ++before;
            while (after + 1 < r.tau.size() && r.tau[after + 1] - r.tau[k] <= difference_reach)
                ++after;
            const std::size_t left = before < k ? before : std::max<std::size_t>(k, 1) - 1,
                              right = after > k ? after : std::min(k + 1, r.tau.size() - 1);
            const double angle = Omega * (r.tau[k] - middle);
            const auto row = static_cast<Eigen::Index>(k - from);
            rows_.row(row) << r.x[k], (r.x[right] - r.x[left]) / (r.tau[right] - r.tau[left]), 1,
                (r.tau[k] - middle) / length, elementary::sin(angle), elementary::cos(angle);
            a_(row) = r.x_ddot[k];
            known_[k - from] = !bad.x[k] && !bad.x[left] && !bad.x[right];
            usable_[k - from] = known_[k - from] && !bad.a[k];
        }
    }

    Eigen::VectorXd left() const {
        Eigen::Matrix<double, columns, 1> z = Eigen::Matrix<double, columns, 1>::Zero();
        Eigen::VectorXd left = a_;
        double scale = infinity;
        for (int fit = 0; fit < fits; ++fit) {
            Eigen::Matrix<double, columns, columns> N =
                Eigen::Matrix<double, columns, columns>::Zero();
            Eigen::Matrix<double, columns, 1> g = Eigen::Matrix<double, columns, 1>::Zero();
            for (Eigen::Index k = 0; k < a_.size(); ++k) {
                if (!usable_[static_cast<std::size_t>(k)]) continue;
                const double off = std::abs(left(k)) / scale,
                             weight = off > off_motion ? off_motion / off : 1;
                N.noalias() += weight * rows_.row(k).transpose() * rows_.row(k);
                g.noalias() += weight * a_(k) * rows_.row(k).transpose();
            }
            // x and x' are a thousandth of the others.
            const Eigen::Matrix<double, columns, 1> size =
                N.diagonal().cwiseSqrt().cwiseMax(1e-300).cwiseInverse();
            Eigen::Matrix<double, columns, columns> scaled =
                size.asDiagonal() * N * size.asDiagonal();
            scaled.diagonal().array() += 1e-9;
            z = size.asDiagonal() * scaled.ldlt().solve(size.asDiagonal() * g);
            left = a_ - rows_ * z;
            scale = deviation(left);
        }
        return left;
    }

    /// Whether the displacement says what the motion is there.
    bool is_known(std::size_t k) const { return known_[k]; }

private:
    double deviation(const Eigen::VectorXd& left) const {
        std::vector<double> values;
        for (Eigen::Index k = 0; k < left.size(); ++k)
            if (usable_[static_cast<std::size_t>(k)]) values.push_back(left(k));
        const double d = robust_deviation(std::move(values));
        return d > 0 ? d : infinity;
    }

    Eigen::Matrix<double, Eigen::Dynamic, columns> rows_;
    Eigen::VectorXd a_;
    std::vector<char> known_, usable_;
};

}  // namespace

PulseSignal pulse_signal(
    const MeasuredRecord& r, const BadSamples& bad, double Omega,
    IdentificationProgress& progress) {
    const std::size_t n = r.tau.size();
    if (r.x.empty()) {
        SmoothBackground background = smooth_background(r, progress);
        return {std::move(background.residual), background.noise};
    }
    PulseSignal signal{std::vector<double>(n), nan};
    std::vector<char> unknown(n, 0);
    const double longest = 2 * std::numbers::pi * stretch_cycles;
    const auto stretches = std::max<std::size_t>(
        1, std::min(
               static_cast<std::size_t>((r.tau.back() - r.tau.front()) / longest),
               n / fewest_samples_of_stretch));
    std::size_t from = 0;
    for (std::size_t i = 1; i <= stretches; ++i) {
        progress.look();
        const double end = r.tau.front() + (r.tau.back() - r.tau.front()) * static_cast<double>(i) /
                                               static_cast<double>(stretches);
        const std::size_t to = i == stretches ? n : first_index(r, end);
        if (i < stretches && to - from < fewest_samples_of_stretch) continue;
        const SampledStretch stretch(r, bad, Omega, from, to);
        const Eigen::VectorXd left = stretch.left();
        for (std::size_t k = from; k < to; ++k) {
            signal.value[k] = left(static_cast<Eigen::Index>(k - from));
            unknown[k] = !stretch.is_known(k - from);
        }
        from = to;
    }
    // Where the displacement says nothing the acceleration has to stand for itself.
    if (std::count(unknown.begin(), unknown.end(), 1) > 0) {
        const SmoothBackground background = smooth_background(r, progress);
        for (std::size_t k = 0; k < n; ++k)
            if (unknown[k]) signal.value[k] = background.residual[k];
    }
    std::vector<double> quiet;
    for (std::size_t k = 0; k < n; ++k)
        if (!bad.a[k]) quiet.push_back(signal.value[k]);
    signal.noise = std::max(robust_deviation(std::move(quiet)), least_noise_of(r.x_ddot));
    return signal;
}

}  // namespace vines
