#include "core/measurement/measured_load.hpp"

#include <Eigen/LU>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

constexpr double fewest_cycles = 5, least_explained = 0.75;
// A crossing counts once the signal passes the mean by this fraction of its standard deviation.
constexpr double hysteresis = 0.5;
// The crossings give the frequency to about one crossing in the whole record. Pieces of this many
// cycles resolve the remaining phase drift, and pieces four times as long refine it.
constexpr double cycles_of_piece = 4;
constexpr int refinements = 6;
constexpr double longer = 4;

double deviation_of(const std::vector<double>& values, double mean) {
    double sum = 0;
    for (const double v : values) sum += (v - mean) * (v - mean);
    return std::sqrt(sum / static_cast<double>(values.size()));
}

/// From the upward mean crossings; 0 with too few.
double rough_omega(
    const std::vector<double>& time, const std::vector<double>& values, double mean, double level) {
    double first = 0, last = 0;
    long crossings = 0;
    bool is_low = false;
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (values[k] < mean - level) is_low = true;
        if (!is_low || values[k] < mean + level) continue;
        is_low = false;
        if (crossings++ == 0) first = time[k];
        last = time[k];
    }
    if (static_cast<double>(crossings - 1) < fewest_cycles) return 0;
    return 2 * std::numbers::pi * static_cast<double>(crossings - 1) / (last - first);
}

struct HarmonicFit {
    Eigen::Vector3d by;  ///< coefficients of sine, cosine and 1
    double squares;      ///< sum of squared residuals
};

HarmonicFit fit_harmonic(
    const std::vector<double>& time, const std::vector<double>& values, double omega,
    std::size_t from, std::size_t to) {
    Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    double squares = 0;
    for (std::size_t k = from; k < to; ++k) {
        const double angle = omega * time[k];
        const Eigen::Vector3d row(elementary::sin(angle), elementary::cos(angle), 1);
        N += row * row.transpose();
        right += values[k] * row;
        squares += values[k] * values[k];
    }
    const Eigen::Vector3d by = N.inverse() * right;
    return {by, squares - by.dot(right)};
}

/// Correction of omega, from the phase drift between pieces of length `piece`.
double omega_off(
    const std::vector<double>& time, const std::vector<double>& values, double omega,
    double piece) {
    double last = 0, turned = 0, n = 0, t = 0, a = 0, tt = 0, ta = 0;
    for (std::size_t from = 0; from < time.size();) {
        std::size_t to = from + 1;
        while (to < time.size() && time[to] < time[from] + piece) ++to;
        // A shorter last piece is ignored.
        if (to == time.size() && from > 0) break;
        const HarmonicFit f = fit_harmonic(time, values, omega, from, to);
        const double angle = elementary::atan2(f.by(1), f.by(0));
        if (n > 0) turned += std::remainder(angle - last, 2 * std::numbers::pi);
        else turned = angle;
        last = angle;
        const double middle = 0.5 * (time[from] + time[to - 1]);
        n += 1, t += middle, a += turned, tt += middle * middle, ta += middle * turned;
        from = to;
    }
    return n > 1 ? (n * ta - t * a) / (n * tt - t * t) : 0;
}

}  // namespace

std::optional<Harmonic> harmonic_of(
    const std::vector<double>& time, const std::vector<double>& values,
    const std::function<void()>& look) {
    const double n = static_cast<double>(values.size()),
                 mean = std::accumulate(values.begin(), values.end(), 0.0) / n,
                 deviation = deviation_of(values, mean);
    double omega = rough_omega(time, values, mean, hysteresis * deviation);
    if (!(omega > 0) || !std::isfinite(omega)) return std::nullopt;
    std::vector<double> about(values);
    for (double& v : about) v -= mean;
    const double duration = time.back() - time.front();
    double piece = cycles_of_piece * 2 * std::numbers::pi / omega;
    for (int k = 0; k < refinements; ++k) {
        look();
        omega += omega_off(time, about, omega, piece);
        if (piece * longer < duration / longer) piece *= longer;
    }
    const HarmonicFit all = fit_harmonic(time, about, omega, 0, time.size());
    if (!(all.squares < (1 - least_explained) * n * deviation * deviation)) return std::nullopt;
    return Harmonic{omega, all.by(0), all.by(1)};
}

}  // namespace vines
