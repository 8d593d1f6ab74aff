#include "core/measurement/background.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/measurement/robust.hpp"
#include "core/motion/special_values.hpp"

namespace vines {

namespace {

// The background of the acceleration is a sine of about the frequency 1 (in tau): over +-.25 a
// parabola fits it to 2e-4. It takes at least 9 samples on each side, of which pulses may cover
// half.
constexpr double background_least = 0.25;
constexpr int background_samples = 9;
// Fewer samples than that beside the pulses make no parabola.
constexpr int parabola_samples = 5;
// No spike is smaller than some times this share of a signal: that much the parabola leaves of the
// sine.
constexpr double background_share = 1e-3;
// A sample further off than so many standard deviations of the noise, and its neighbours, are no
// part of the background.
constexpr double masking_sigmas = 4;
// Rounds of masking, in case that two masks take turns.
constexpr int masking_rounds = 8;

/// The samples within so much of one: [from, to), moved along with it.
struct Neighbourhood {
    std::size_t from = 0, to = 0;

    void move_to(std::size_t k, const std::vector<double>& tau, double reach) {
        while (tau[k] - tau[from] > reach) ++from;
        while (to < tau.size() && tau[to] - tau[k] <= reach) ++to;
    }
};

/// Values in order, without those that are NaN.
class OrderedValues {
public:
    void add(double value) {
        if (!std::isnan(value)) values_.insert(place_of(value), value);
    }
    void remove(double value) {
        if (!std::isnan(value)) values_.erase(place_of(value));
    }
    /// NaN of nothing.
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

/// Of going once through a neighbourhood, for IdentificationProgress::tick.
std::size_t work_of(const Neighbourhood& near) { return 1 + (near.to - near.from) / 64; }

/// What stands out from the median of its neighbourhood: the first guess.
std::vector<double> without_median(
    const MeasuredRecord& r, double reach, IdentificationProgress& progress) {
    std::vector<double> residual(r.tau.size());
    OrderedValues values;
    Neighbourhood near;
    for (std::size_t k = 0; k < r.tau.size(); ++k) {
        const Neighbourhood before = near;
        near.move_to(k, r.tau, reach);
        for (std::size_t j = before.from; j < std::min(before.to, near.from); ++j) {
            progress.tick(work_of(near));
            values.remove(r.x_ddot[j]);
        }
        for (std::size_t j = std::max(before.to, near.from); j < near.to; ++j) {
            progress.tick(work_of(near));
            values.add(r.x_ddot[j]);
        }
        residual[k] = r.x_ddot[k] - values.median();
    }
    return residual;
}

/// The least-squares parabola through samples, as its normal equations N z = g.
struct ParabolaEquations {
    double count = 0, s = 0, s_squared = 0, s_cubed = 0, s_fourth = 0;
    Eigen::Vector3d g = Eigen::Vector3d::Zero();

    void add(double at, double value) {
        const double squared = at * at;
        count += 1;
        s += at;
        s_squared += squared;
        s_cubed += at * squared;
        s_fourth += squared * squared;
        g += Eigen::Vector3d(value, at * value, squared * value);
    }
    /// The parabola at 0.
    double solve() const {
        Eigen::Matrix3d N;
        N << count, s, s_squared, s, s_squared, s_cubed, s_squared, s_cubed, s_fourth;
        return N.ldlt().solve(g)(0);
    }
};

/// What is left of the acceleration without its smooth background: a parabola through the unmasked
/// neighbours of each sample.
class BackgroundFit {
public:
    BackgroundFit(const MeasuredRecord& r, double reach, IdentificationProgress& progress)
        : r_(r),
          reach_(reach),
          progress_(progress),
          residual_(r.tau.size(), 0) {}

    const std::vector<double>& residual() const { return residual_; }

    /// By another mask than the last one: only samples with a neighbour at which the two differ are
    /// looked at anew.
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
    /// 0 where too few neighbours are left.
    double residual_at(std::size_t k, const Neighbourhood& near) const {
        ParabolaEquations equations;
        for (std::size_t j = near.from; j < near.to; ++j)
            if (!masked_[j]) equations.add((r_.tau[j] - r_.tau[k]) / reach_, r_.x_ddot[j]);
        return equations.count >= parabola_samples ? r_.x_ddot[k] - equations.solve() : 0;
    }

    const MeasuredRecord& r_;
    const double reach_;
    IdentificationProgress& progress_;
    std::vector<char> masked_;
    std::vector<double> residual_;
};

double noise_beside(const std::vector<char>& masked, const std::vector<double>& residual) {
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

}  // namespace

double least_noise_of(const std::vector<double>& signal) {
    const double middle = median(signal);
    std::vector<double> off(signal);
    for (double& value : off) value -= middle;
    return background_share * robust_deviation(std::move(off));
}

SmoothBackground smooth_background(const MeasuredRecord& r, IdentificationProgress& progress) {
    const std::size_t n = r.tau.size();
    const double reach = std::max(background_least, background_samples * sample_interval(r));
    SmoothBackground found{{}, ThirdDifferences(r.tau, r.x_ddot).noise()};
    // First what stands out from the median of its neighbourhood; then, again and again, from the
    // parabola through the rest.
    std::vector<double> residual = without_median(r, reach, progress);
    const double coarse = std::max(found.noise, robust_deviation(residual));
    std::vector<char> masked(n, 0);
    for (std::size_t k = 0; k < n; ++k) masked[k] = std::abs(residual[k]) > masking_sigmas * coarse;
    residual = {};
    BackgroundFit background(r, reach, progress);
    for (int round = 0; round < masking_rounds; ++round) {
        background.mask(std::move(masked));
        found.noise = noise_beside(background.masked(), background.residual());
        masked = mask_of(background.residual(), found.noise);
        if (masked == background.masked()) break;
    }
    found.noise = std::max(found.noise, least_noise_of(r.x_ddot));
    found.residual = background.residual();
    return found;
}

}  // namespace vines
