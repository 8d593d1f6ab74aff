#include "core/identification/spikes.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "core/identification/robust.hpp"
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
// A spike reaches as far as its samples are so many standard deviations above the noise.
constexpr double spike_foot_sigmas = 3;

/// The samples within so much of one: [from, to), moved along with it.
struct Neighbourhood {
    std::size_t from = 0, to = 0;

    void move_to(std::size_t k, const std::vector<double>& tau, double reach) {
        while (tau[k] - tau[from] > reach) ++from;
        while (to < tau.size() && tau[to] - tau[k] <= reach) ++to;
    }
};

/// What stands out from the median of its neighbourhood: the first guess.
std::vector<double> without_median(const MeasuredRecord& r, double reach) {
    std::vector<double> residual(r.tau.size()), window;
    Neighbourhood near;
    for (std::size_t k = 0; k < r.tau.size(); ++k) {
        near.move_to(k, r.tau, reach);
        window.assign(
            r.x_ddot.begin() + static_cast<std::ptrdiff_t>(near.from),
            r.x_ddot.begin() + static_cast<std::ptrdiff_t>(near.to));
        residual[k] = r.x_ddot[k] - median(window);
    }
    return residual;
}

/// What is left of the acceleration without its smooth background: a parabola through the unmasked
/// neighbours of each sample.
std::vector<double> without_background(
    const MeasuredRecord& r, const std::vector<char>& masked, double reach) {
    std::vector<double> residual(r.tau.size(), 0);
    Neighbourhood near;
    for (std::size_t k = 0; k < r.tau.size(); ++k) {
        near.move_to(k, r.tau, reach);
        Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        int used = 0;
        for (std::size_t j = near.from; j < near.to; ++j) {
            if (masked[j]) continue;
            const double s = (r.tau[j] - r.tau[k]) / reach;
            const Eigen::Vector3d row(1, s, s * s);
            N += row * row.transpose();
            g += row * r.x_ddot[j];
            ++used;
        }
        if (used >= parabola_samples) residual[k] = r.x_ddot[k] - N.ldlt().solve(g)(0);
    }
    return residual;
}

double noise_beside(const std::vector<char>& masked, const std::vector<double>& residual) {
    std::vector<double> quiet;
    for (std::size_t k = 0; k < residual.size(); ++k)
        if (!masked[k]) quiet.push_back(residual[k]);
    return robust_deviation(quiet);
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

std::vector<Spike> spikes_in(
    const MeasuredRecord& r, const std::vector<double>& residual, double noise, double sigmas,
    double longest) {
    std::vector<Spike> spikes;
    const std::size_t n = r.tau.size();
    for (std::size_t k = 0; k < n;) {
        if (!(std::abs(residual[k]) > spike_foot_sigmas * noise)) {
            ++k;
            continue;
        }
        const double sign = residual[k] > 0 ? 1 : -1;
        double area = 0, moment = 0, height = 0;
        std::size_t j = k;
        for (; j < n && sign * residual[j] > spike_foot_sigmas * noise; ++j) {
            const double width = 0.5 * (r.tau[std::min(j + 1, n - 1)] - r.tau[j > 0 ? j - 1 : 0]);
            area += residual[j] * width;
            moment += residual[j] * width * r.tau[j];
            height = std::max(height, sign * residual[j]);
        }
        if (height > sigmas * noise && r.tau[j - 1] - r.tau[k] < longest &&
            std::isfinite(moment / area))
            spikes.push_back({moment / area, sign > 0 ? -1 : 1, area, height / noise});
        k = j;
    }
    return spikes;
}

double least_noise_of(const std::vector<double>& signal) {
    return background_share * robust_deviation(signal);
}

double typical_jump(const std::vector<Spike>& spikes) {
    std::vector<double> jumps;
    for (const Spike& s : spikes) jumps.push_back(std::abs(s.jump));
    return spikes.empty() ? 0 : median(std::move(jumps));
}

Spikes find_spikes(const MeasuredRecord& r, double sigmas) {
    const std::size_t n = r.tau.size();
    const double reach = std::max(background_least, background_samples * sample_interval(r));
    Spikes found{{}, difference_noise(r.tau, r.x_ddot)};
    // First what stands out from the median of its neighbourhood; then, again and again, from the
    // parabola through the rest.
    std::vector<double> residual = without_median(r, reach);
    const double coarse = std::max(found.noise, robust_deviation(residual));
    std::vector<char> masked(n, 0);
    for (std::size_t k = 0; k < n; ++k) masked[k] = std::abs(residual[k]) > masking_sigmas * coarse;
    for (int round = 0; round < masking_rounds; ++round) {
        residual = without_background(r, masked, reach);
        found.noise = noise_beside(masked, residual);
        std::vector<char> next = mask_of(residual, found.noise);
        if (next == masked) break;
        masked = std::move(next);
    }
    found.noise = std::max(found.noise, least_noise_of(r.x_ddot));
    found.spikes = spikes_in(r, residual, found.noise, sigmas, infinity);
    return found;
}

}  // namespace vines
