// The impact pulses in an acceleration, after subtraction of the oscillator's motion.
//
// With a displacement, the motion is fitted to it: between impacts x'' is a linear combination of
// x, x' and the forcing. Without one, or where it is unusable, the motion is the smooth background
// of the acceleration: a parabola through the neighbours of each sample, without those in a pulse.
// The pulses are masked in rounds, first by a running median, then by the parabola.
#include "core/measurement/candidates.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/measurement/robust.hpp"
#include "core/motion/elementary.hpp"

namespace vines {

namespace {

// The background is nearly a sine of frequency 1 (in tau): over +-.25 a parabola fits it to 2e-4.
// The neighbourhood holds at least 9 samples on each side, because pulses may cover half of them.
constexpr double background_least = 0.25;
constexpr int background_samples = 9;
// Minimum number of unmasked samples for a parabola.
constexpr int parabola_samples = 5;
// Samples further off than this many standard deviations of the noise, and their neighbours, are
// masked.
constexpr double masking_sigmas = 4;
// Limit on the masking rounds, in case two masks alternate.
constexpr int masking_rounds = 8;

/// Samples [from, to) within `reach` of a sample that moves forward.
struct Neighbourhood {
    std::size_t from = 0, to = 0;

    void move_to(std::size_t k, const std::vector<double>& tau, double reach) {
        while (tau[k] - tau[from] > reach) ++from;
        while (to < tau.size() && tau[to] - tau[k] <= reach) ++to;
    }
};

/// Sorted values without NaN.
class OrderedValues {
public:
    void add(double value) {
        if (!std::isnan(value)) values_.insert(place_of(value), value);
    }
    void remove(double value) {
        if (!std::isnan(value)) values_.erase(place_of(value));
    }
    /// NaN without values.
    double median() const {
        if (values_.empty()) return nan;
        const std::size_t middle = values_.size() / 2;
        return values_.size() % 2 ? values_[middle] : 0.5 * (values_[middle] + values_[middle - 1]);
    }

private:
    std::vector<double>::iterator place_of(double value) {
        return std::lower_bound(values_.begin(), values_.end(), value);
    }
    std::vector<double> values_;
};

/// Work of one pass through a neighbourhood, for IdentificationProgress::tick.
std::size_t work_of(const Neighbourhood& near) { return 1 + (near.to - near.from) / 64; }

/// Deviation from the median of the neighbourhood: the first approximation.
std::vector<double> without_median(const ImpactSearchInput& in, double reach) {
    const MeasuredRecord& r = in.record;
    std::vector<double> residual(r.tau.size());
    OrderedValues values;
    Neighbourhood near;
    for (std::size_t k = 0; k < r.tau.size(); ++k) {
        const Neighbourhood before = near;
        near.move_to(k, r.tau, reach);
        for (std::size_t j = before.from; j < std::min(before.to, near.from); ++j) {
            in.progress.tick(work_of(near));
            values.remove(r.x_ddot[j]);
        }
        for (std::size_t j = std::max(before.to, near.from); j < near.to; ++j) {
            in.progress.tick(work_of(near));
            values.add(r.x_ddot[j]);
        }
        residual[k] = r.x_ddot[k] - values.median();
    }
    return residual;
}

/// Least-squares parabola through samples, as normal equations N z = g.
struct ParabolaEquations {
    Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
    Eigen::Vector3d g = Eigen::Vector3d::Zero();

    void add(double at, double value) {
        const Eigen::Vector3d row(1, at, at * at);
        N += row * row.transpose();
        g += value * row;
    }
    double count() const { return N(0, 0); }
    /// Value at 0.
    double solve() const { return N.ldlt().solve(g)(0); }
};

/// Residual of the acceleration: each sample minus the parabola through its unmasked neighbours.
class BackgroundFit {
public:
    BackgroundFit(const ImpactSearchInput& in, double reach)
        : r_(in.record),
          reach_(reach),
          progress_(in.progress),
          residual_(r_.tau.size(), 0) {}

    const std::vector<double>& residual() const { return residual_; }

    /// Applies another mask; only samples with a neighbour at which the masks differ are
    /// recomputed.
    void mask(std::vector<char> masked) {
        const std::vector<char> before = std::exchange(masked_, std::move(masked));
        Neighbourhood near;
        std::size_t changed = 0;
        for (std::size_t k = 0; k < r_.tau.size(); ++k) {
            near.move_to(k, r_.tau, reach_);
            progress_.tick(work_of(near));
            changed = std::max(changed, near.from);
            while (changed < near.to && !before.empty() && masked_[changed] == before[changed])
                ++changed;
            if (changed < near.to) residual_[k] = residual_at(k, near);
        }
    }

    const std::vector<char>& masked() const { return masked_; }

private:
    /// 0 if too few neighbours are unmasked.
    double residual_at(std::size_t k, const Neighbourhood& near) const {
        ParabolaEquations equations;
        for (std::size_t j = near.from; j < near.to; ++j)
            if (!masked_[j]) equations.add((r_.tau[j] - r_.tau[k]) / reach_, r_.x_ddot[j]);
        return equations.count() >= parabola_samples ? r_.x_ddot[k] - equations.solve() : 0;
    }

    const MeasuredRecord& r_;
    const double reach_;
    IdentificationProgress& progress_;
    std::vector<char> masked_;
    std::vector<double> residual_;
};

double noise_outside(const std::vector<char>& masked, const std::vector<double>& residual) {
    std::vector<double> quiet;
    for (std::size_t k = 0; k < residual.size(); ++k)
        if (!masked[k]) quiet.push_back(residual[k]);
    return robust_deviation(std::move(quiet));
}

/// Samples above the noise, each with its neighbours.
std::vector<char> mask_of(const std::vector<double>& residual, double noise) {
    const std::size_t n = residual.size();
    std::vector<char> masked(n, 0);
    for (std::size_t k = 0; k < n; ++k)
        if (std::abs(residual[k]) > masking_sigmas * noise)
            for (std::size_t j = k > 0 ? k - 1 : 0; j <= std::min(k + 1, n - 1); ++j) masked[j] = 1;
    return masked;
}

/// Subtracts a parabola through the neighbours of each sample outside pulses. Needs x_ddot.
PulseSignal smooth_background(const ImpactSearchInput& in) {
    const MeasuredRecord& r = in.record;
    const std::size_t n = r.tau.size();
    const double reach = std::max(background_least, background_samples * in.statistics.step);
    PulseSignal found{{}, third_difference_noise(r.tau, r.x_ddot)};
    std::vector<double> residual = without_median(in, reach);
    const double coarse = std::max(found.noise, robust_deviation(residual));
    std::vector<char> masked(n, 0);
    for (std::size_t k = 0; k < n; ++k) masked[k] = std::abs(residual[k]) > masking_sigmas * coarse;
    residual = {};
    BackgroundFit background(in, reach);
    for (int round = 0; round < masking_rounds; ++round) {
        background.mask(std::move(masked));
        found.noise = noise_outside(background.masked(), background.residual());
        masked = mask_of(background.residual(), found.noise);
        if (masked == background.masked()) break;
    }
    found.noise = std::max(found.noise, in.statistics.a.least_noise);
    found.value = background.residual();
    return found;
}

// Cycles of the oscillator in a stretch: a frequency error of .3 % slips by .15 rad within it.
constexpr double stretch_cycles = 8;
// Number of reweighted fits; samples further off than this many standard deviations get less
// weight.
constexpr int fits = 12;
constexpr double off_motion = 2;
constexpr Eigen::Index columns = 6;
// x' at a sample is a difference over this tau on both sides. The difference amplifies noise, but
// its coefficient is small: damping and the displacement's delay.
constexpr double difference_reach = 0.1;
constexpr std::size_t fewest_samples_of_stretch = 40;

/// Samples [from, to) of a record with the measured motion.
class SampledStretch {
public:
    SampledStretch(const ImpactSearchInput& in, std::size_t from, std::size_t to)
        : rows_(static_cast<Eigen::Index>(to - from), columns),
          a_(static_cast<Eigen::Index>(to - from)),
          known_(to - from),
          usable_(to - from) {
        const MeasuredRecord& r = in.record;
        const std::vector<char>&bad_x = in.statistics.x.bad, &bad_a = in.statistics.a.bad;
        const double middle = 0.5 * (r.tau[from] + r.tau[to - 1]),
                     length = r.tau[to - 1] - r.tau[from];
        std::size_t before = from, after = from;
        for (std::size_t k = from; k < to; ++k) {
            while (r.tau[k] - r.tau[before] > difference_reach && before < k) ++before;
            while (after + 1 < r.tau.size() && r.tau[after + 1] - r.tau[k] <= difference_reach)
                ++after;
            const std::size_t left = before < k ? before : std::max<std::size_t>(k, 1) - 1,
                              right = after > k ? after : std::min(k + 1, r.tau.size() - 1);
            const double angle = in.parameters.Omega * (r.tau[k] - middle);
            const auto row = static_cast<Eigen::Index>(k - from);
            rows_.row(row) << r.x[k], (r.x[right] - r.x[left]) / (r.tau[right] - r.tau[left]), 1,
                (r.tau[k] - middle) / length, elementary::sin(angle), elementary::cos(angle);
            a_(row) = r.x_ddot[k];
            known_[k - from] = !bad_x[k] && !bad_x[left] && !bad_x[right];
            usable_[k - from] = known_[k - from] && !bad_a[k];
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
            // The columns of x and x' are about a thousandth of the others.
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

    /// Whether the displacement is usable at sample k of the stretch.
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

PulseSignal pulse_signal(const ImpactSearchInput& in) {
    const MeasuredRecord& r = in.record;
    const std::size_t n = r.tau.size();
    if (r.x.empty()) return smooth_background(in);
    PulseSignal signal{std::vector<double>(n), nan};
    std::vector<char> unknown(n, 0);
    const double longest = 2 * std::numbers::pi * stretch_cycles;
    const auto stretches = std::max<std::size_t>(
        1, std::min(
               static_cast<std::size_t>((r.tau.back() - r.tau.front()) / longest),
               n / fewest_samples_of_stretch));
    std::size_t from = 0;
    for (std::size_t i = 1; i <= stretches; ++i) {
        in.progress.look();
        const double end = r.tau.front() + (r.tau.back() - r.tau.front()) * static_cast<double>(i) /
                                               static_cast<double>(stretches);
        const std::size_t to = i == stretches ? n : first_index(r, end);
        if (i < stretches && to - from < fewest_samples_of_stretch) continue;
        const SampledStretch stretch(in, from, to);
        const Eigen::VectorXd left = stretch.left();
        for (std::size_t k = from; k < to; ++k) {
            signal.value[k] = left(static_cast<Eigen::Index>(k - from));
            unknown[k] = !stretch.is_known(k - from);
        }
        from = to;
    }
    // Where the displacement is unusable, the smooth part of the acceleration replaces it.
    if (std::ranges::count(unknown, 1) > 0) {
        const PulseSignal background = smooth_background(in);
        for (std::size_t k = 0; k < n; ++k)
            if (unknown[k]) signal.value[k] = background.value[k];
    }
    std::vector<double> quiet;
    for (std::size_t k = 0; k < n; ++k)
        if (!in.statistics.a.bad[k]) quiet.push_back(signal.value[k]);
    signal.noise = std::max(robust_deviation(std::move(quiet)), in.statistics.a.least_noise);
    return signal;
}

}  // namespace vines
