#include "core/identification/identify.hpp"
#include "core/motion/special_values.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/identification/robust.hpp"

namespace vines {

namespace {

/// The typical one: a record may have gaps.
double sample_interval(const MeasuredRecord& r) {
    std::vector<double> steps;
    for (std::size_t k = 1; k < r.tau.size(); ++k) steps.push_back(r.tau[k] - r.tau[k - 1]);
    return median(std::move(steps));
}

// Pulses of impacts between hard bodies last .2 to 2 ms; at an oscillator of 8 Hz that is .01 to .1
// in tau.
constexpr double shortest_pulse = 0.005, longest_pulse = 0.15;
// Lengths of pulses that are tried, each over the one before: 58 between the two above.
constexpr double pulse_ratio = 1.06;
// x is continuous at an impact: of the noise of one sample the fit may leave it that much of a
// jump. Far smaller, and the equations lose digits; larger, and the kink in x tells less of the
// moment.
constexpr double continuity_share = 0.05;
// A jump of x' without a spike is an impact only beyond this many standard errors. It is looked for
// in so many samples at once.
constexpr double kink_sigmas = 7;
constexpr std::size_t kink_window = 400;
// Of n samples in units of the noise: white noise leaves n +- sqrt(2 n), and noise that was
// estimated from few samples a little more. An interval that leaves no more than this is not
// searched.
double unsuspicious_misfit(std::size_t n) { return 1.3 * static_cast<double>(n) + 10; }
// The jump of a real impact is the area of its spike; noise and few samples leave that much of it.
constexpr double least_jump = 0.25;

// The background of the acceleration is a sine of about the frequency 1 (in tau): over +-.25 a
// parabola fits it to 2e-4. It takes at least 9 samples on each side, of which pulses may cover
// half.
constexpr double background_least = 0.25;
constexpr int background_samples = 9;
// A record with hardly any noise shows what the parabola, or a frequency that is a little off,
// leaves of the sine: no spike is smaller than some times this share of it.
constexpr double background_share = 1e-3;

/// What is left of the acceleration without its smooth background: a parabola through the unmasked
/// neighbours of each sample.
std::vector<double> without_background(
    const MeasuredRecord& r, const std::vector<char>& masked, double background) {
    const std::size_t n = r.tau.size();
    std::vector<double> left(n, 0);
    std::size_t from = 0, to = 0;
    for (std::size_t k = 0; k < n; ++k) {
        while (r.tau[k] - r.tau[from] > background) ++from;
        while (to < n && r.tau[to] - r.tau[k] <= background) ++to;
        Eigen::Matrix3d N = Eigen::Matrix3d::Zero();
        Eigen::Vector3d g = Eigen::Vector3d::Zero();
        int used = 0;
        for (std::size_t j = from; j < to; ++j) {
            if (masked[j]) continue;
            const double s = (r.tau[j] - r.tau[k]) / background;
            const Eigen::Vector3d row(1, s, s * s);
            N += row * row.transpose();
            g += row * r.x_ddot[j];
            ++used;
        }
        if (used >= 5) left[k] = r.x_ddot[k] - N.ldlt().solve(g)(0);
    }
    return left;
}

/// Neighbouring samples of one sign above the noise are one spike, unless they last longer than
/// `longest`.
std::vector<Spike> grouped(
    const MeasuredRecord& r, const std::vector<double>& left, double noise, double sigmas,
    double longest) {
    std::vector<Spike> spikes;
    const std::size_t n = r.tau.size();
    for (std::size_t k = 0; k < n;) {
        if (!(std::abs(left[k]) > 3 * noise)) {
            ++k;
            continue;
        }
        const double sign = left[k] > 0 ? 1 : -1;
        double area = 0, moment = 0, height = 0;
        std::size_t j = k;
        for (; j < n && sign * left[j] > 3 * noise; ++j) {
            const double width = 0.5 * (r.tau[std::min(j + 1, n - 1)] - r.tau[j > 0 ? j - 1 : 0]);
            area += left[j] * width;
            moment += left[j] * width * r.tau[j];
            height = std::max(height, sign * left[j]);
        }
        if (height > sigmas * noise && r.tau[j - 1] - r.tau[k] < longest &&
            std::isfinite(moment / area))
            spikes.push_back({moment / area, sign > 0 ? -1 : 1, area, height / noise});
        k = j;
    }
    return spikes;
}

}  // namespace

std::vector<TimeGap> time_gaps(const MeasuredRecord& r) {
    std::vector<TimeGap> gaps;
    const double longest = 3 * sample_interval(r);
    for (std::size_t k = 1; k < r.tau.size(); ++k)
        if (r.tau[k] - r.tau[k - 1] > longest) gaps.push_back({r.tau[k - 1], r.tau[k]});
    return gaps;
}

Spikes find_spikes(const MeasuredRecord& r, double sigmas) {
    const std::size_t n = r.tau.size();
    const double background = std::max(background_least, background_samples * sample_interval(r));
    Spikes found{{}, difference_noise(r.tau, r.x_ddot)};
    // First what stands out from the median of its neighbourhood; then, again and again, from the
    // parabola through the rest.
    std::vector<char> masked(n, 0);
    std::vector<double> left(n), window;
    for (std::size_t k = 0, from = 0, to = 0; k < n; ++k) {
        while (r.tau[k] - r.tau[from] > background) ++from;
        while (to < n && r.tau[to] - r.tau[k] <= background) ++to;
        window.assign(
            r.x_ddot.begin() + static_cast<std::ptrdiff_t>(from),
            r.x_ddot.begin() + static_cast<std::ptrdiff_t>(to));
        left[k] = r.x_ddot[k] - median(window);
    }
    const double coarse = std::max(found.noise, robust_deviation(left));
    for (std::size_t k = 0; k < n; ++k) masked[k] = std::abs(left[k]) > 4 * coarse;
    for (int round = 0; round < 8; ++round) {
        left = without_background(r, masked, background);
        std::vector<double> quiet;
        for (std::size_t k = 0; k < n; ++k)
            if (!masked[k]) quiet.push_back(left[k]);
        found.noise = robust_deviation(quiet);
        std::vector<char> next(n, 0);
        for (std::size_t k = 0; k < n; ++k)
            if (std::abs(left[k]) > 4 * found.noise)
                for (std::size_t j = k > 0 ? k - 1 : 0; j <= std::min(k + 1, n - 1); ++j)
                    next[j] = 1;
        if (next == masked) break;
        masked = std::move(next);
    }
    found.noise = std::max(found.noise, background_share * robust_deviation(r.x_ddot));
    found.spikes = grouped(r, left, found.noise, sigmas, infinity);
    return found;
}

namespace {

/// x, x' and x'' of the linear model at a time s after an interval's start: their derivatives by x,
/// x' there and by the two parts of the forcing.
struct Rows {
    Eigen::Vector4d x, x_dot, x_ddot;
};

class Model {
public:
    explicit Model(const Parameters& p)
        : damping_(2 * p.zeta()),
          Omega_(p.Omega),
          flow_(1, 2 * p.zeta(), 1, p.Omega) {}

    Rows at(double tau, double s) const {
        const double sin = std::sin(Omega_ * tau), cos = std::cos(Omega_ * tau);
        const Oscillation parts[4] = {
            flow_.after({1, 0, 0, 0}, s), flow_.after({0, 1, 0, 0}, s),
            flow_.after({0, 0, sin, cos}, s), flow_.after({0, 0, cos, -sin}, s)};
        Rows rows;
        for (int k = 0; k < 4; ++k) {
            rows.x(k) = parts[k].x;
            rows.x_dot(k) = parts[k].x_dot;
            rows.x_ddot(k) =
                -parts[k].x - damping_ * parts[k].x_dot + (k >= 2 ? parts[k].sin_theta : 0);
        }
        return rows;
    }

    /// x at a time s after x' was raised by one.
    double velocity_response(double s) const { return flow_.transfer(s).a21; }

private:
    const double damping_, Omega_;
    const Flow flow_;
};

/// The normal equations: two unknowns for each interval, then the two of the forcing.
class Equations {
public:
    explicit Equations(std::size_t intervals)
        : unknowns_(static_cast<Eigen::Index>(2 * intervals + 2)),
          right_(Eigen::VectorXd::Zero(unknowns_)) {}

    /// The normal matrix and right side of interval i's samples, by its start and the forcing.
    void add(std::size_t i, const Eigen::Matrix4d& N, const Eigen::Vector4d& g) {
        const Eigen::Index at[4] = {
            static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * i + 1), unknowns_ - 2,
            unknowns_ - 1};
        for (int j = 0; j < 4; ++j) {
            right_(at[j]) += g(j);
            for (int k = 0; k < 4; ++k) triplets_.emplace_back(at[j], at[k], N(j, k));
        }
    }
    /// x at the end of interval i (row) is x at the start of the next.
    void connect(std::size_t i, const Eigen::Vector4d& row, double weight) {
        Eigen::Matrix<double, 5, 1> all;
        all << row, -1;
        const Eigen::Index at[5] = {
            static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * i + 1), unknowns_ - 2,
            unknowns_ - 1, static_cast<Eigen::Index>(2 * i + 2)};
        for (int j = 0; j < 5; ++j)
            for (int k = 0; k < 5; ++k)
                triplets_.emplace_back(at[j], at[k], weight * weight * all(j) * all(k));
    }
    Eigen::VectorXd solve() {
        // An interval without a sample, or a record that does not show the forcing, leaves its
        // unknowns at zero.
        for (Eigen::Index k = 0; k < unknowns_; ++k) triplets_.emplace_back(k, k, 1e-9);
        Eigen::SparseMatrix<double> N(unknowns_, unknowns_);
        N.setFromTriplets(triplets_.begin(), triplets_.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(N);
        // Without a factorisation solve() leaves its result unset. A motion of zero explains
        // nothing, and is seen to.
        if (solver.info() != Eigen::Success) return Eigen::VectorXd::Zero(unknowns_);
        const Eigen::VectorXd z = solver.solve(right_);
        return z.allFinite() ? z : Eigen::VectorXd(Eigen::VectorXd::Zero(unknowns_));
    }

private:
    const Eigen::Index unknowns_;
    std::vector<Eigen::Triplet<double>> triplets_;
    Eigen::VectorXd right_;
};

/// What a fit leaves of a sensor over the noise of that sensor, which is seen beside the pulses. Of
/// the nine in ten that lie closest: a motion may be wrong in a part of the record, but a few odd
/// samples are no misfit.
double misfit_of(
    const std::vector<double>& left, const std::vector<double>& tau,
    const std::vector<double>& signal, const std::vector<char>& spoiled) {
    const double floor = background_share * robust_deviation(signal),
                 noise = std::hypot(difference_noise(tau, signal, spoiled), floor);
    // Of a normal distribution lie within that many standard deviations.
    constexpr double ninety_percent = 1.645;
    return quantile_of_moduli(left, 0.9) / ninety_percent / noise;
}

/// Half a sine of area 1 and length `pulse` about 0.
double pulse_shape(double s, double pulse) {
    return std::abs(s) < 0.5 * pulse
               ? 0.5 * std::numbers::pi / pulse * std::cos(std::numbers::pi * s / pulse)
               : 0;
}

}  // namespace

FittedMotion fit_motion(
    const Parameters& p, const MeasuredRecord& r, const std::vector<double>& impacts,
    double pulse) {
    const Model model(p);
    FittedMotion m;
    m.tau = {r.tau.front()};
    m.tau.insert(m.tau.end(), impacts.begin(), impacts.end());
    const std::size_t n = m.tau.size();
    // The pulse spoils the acceleration on both sides of an impact.
    const double guard = 0.5 * pulse + 0.1 * sample_interval(r);
    const double sigma_x = r.x.empty() ? nan : std::max(difference_noise(r.tau, r.x), 1e-12),
                 sigma_a =
                     r.x_ddot.empty() ? nan : std::max(difference_noise(r.tau, r.x_ddot), 1e-12);
    struct Sample {
        std::size_t interval;
        Eigen::Vector4d x, x_ddot;
        bool spike;
    };
    std::vector<Sample> samples;
    samples.reserve(r.tau.size());
    std::vector<Eigen::Matrix4d> N(n, Eigen::Matrix4d::Zero());
    std::vector<Eigen::Vector4d> g(n, Eigen::Vector4d::Zero());
    std::size_t i = 0;
    for (std::size_t k = 0; k < r.tau.size(); ++k) {
        while (i + 1 < n && m.tau[i + 1] <= r.tau[k]) ++i;
        const Rows rows = model.at(m.tau[i], r.tau[k] - m.tau[i]);
        const bool spike = (i > 0 && r.tau[k] - m.tau[i] < guard) ||
                           (i + 1 < n && m.tau[i + 1] - r.tau[k] < guard);
        samples.push_back({i, rows.x, rows.x_ddot, spike});
        auto add = [&](const Eigen::Vector4d& row, double value, double sigma) {
            const Eigen::Vector4d scaled = row / sigma;
            N[i] += scaled * scaled.transpose();
            g[i] += scaled * (value / sigma);
        };
        if (!r.x.empty()) add(rows.x, r.x[k], sigma_x);
        if (!r.x_ddot.empty() && !spike) add(rows.x_ddot, r.x_ddot[k], sigma_a);
    }
    Equations equations(n);
    std::vector<Rows> ends;
    const double sigma_c = continuity_share * (r.x.empty() ? sigma_a : sigma_x);
    for (std::size_t k = 0; k < n; ++k) {
        equations.add(k, N[k], g[k]);
        if (k + 1 == n) break;
        ends.push_back(model.at(m.tau[k], m.tau[k + 1] - m.tau[k]));
        equations.connect(k, ends[k].x, 1 / sigma_c);
    }
    const Eigen::VectorXd z = equations.solve();
    m.force_sin = z(z.size() - 2), m.force_cos = z(z.size() - 1);
    const Eigen::Vector2d force(m.force_sin, m.force_cos);

    // Each interval by itself, and what it then knows of its start.
    std::vector<Eigen::Matrix2d> covariance;
    for (std::size_t k = 0; k < n; ++k) {
        m.x.push_back(z(static_cast<Eigen::Index>(2 * k)));
        m.x_dot.push_back(z(static_cast<Eigen::Index>(2 * k + 1)));
        covariance.push_back(
            (N[k].topLeftCorner<2, 2>() + 1e-9 * Eigen::Matrix2d::Identity()).inverse());
        const Eigen::Vector2d own =
            covariance[k] * (g[k].head<2>() - N[k].topRightCorner<2, 2>() * force);
        m.own_x.push_back(own(0));
        m.own_x_dot.push_back(own(1));
    }
    const auto start = [&](double x, double x_dot) {
        return Eigen::Vector4d(x, x_dot, force(0), force(1));
    };
    // An interval with hardly a sample says nothing.
    const auto error = [](double variance) {
        return variance > 0 ? std::sqrt(variance) : infinity;
    };
    for (std::size_t k = 0; k + 1 < n; ++k) {
        const Eigen::Vector4d before = start(m.x[k], m.x_dot[k]),
                              own = start(m.own_x[k], m.own_x_dot[k]);
        m.x_dot_before.push_back(ends[k].x_dot.dot(before));
        m.x_ddot_before.push_back(ends[k].x_ddot.dot(before));
        m.x_ddot_after.push_back(
            model.at(m.tau[k + 1], 0).x_ddot.dot(start(m.x[k + 1], m.x_dot[k + 1])));
        m.gap.push_back(ends[k].x.dot(own) - m.own_x[k + 1]);
        m.gap_rate.push_back(ends[k].x_dot.dot(own) - m.own_x_dot[k + 1]);
        const Eigen::Vector2d row = ends[k].x.head<2>(), speed = ends[k].x_dot.head<2>();
        m.gap_error.push_back(error(row.dot(covariance[k] * row) + covariance[k + 1](0, 0)));
        m.jump_error.push_back(error(speed.dot(covariance[k] * speed) + covariance[k + 1](1, 1)));
    }

    std::vector<double> left_x, left_a;
    std::vector<char> spoiled;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const Sample& s = samples[k];
        const Eigen::Vector4d from = start(m.x[s.interval], m.x_dot[s.interval]);
        spoiled.push_back(s.spike);
        if (!r.x.empty()) left_x.push_back(r.x[k] - s.x.dot(from));
        if (r.x_ddot.empty()) continue;
        m.left.push_back(r.x_ddot[k] - s.x_ddot.dot(from));
        if (!s.spike) left_a.push_back(m.left.back());
    }
    m.noise_x = r.x.empty() ? nan : robust_deviation(left_x);
    m.noise_x_ddot = r.x_ddot.empty() ? nan : robust_deviation(left_a);
    m.misfit_x = r.x.empty() ? nan : misfit_of(left_x, r.tau, r.x, spoiled);
    m.misfit_x_ddot = r.x_ddot.empty() ? nan : misfit_of(left_a, r.tau, r.x_ddot, spoiled);
    return m;
}

namespace {

/// What is left of the acceleration around an impact, and how well a moment and a pulse length
/// explain it.
class Around {
public:
    Around(
        const Parameters& p, const MeasuredRecord& r, const FittedMotion& m, std::size_t impact,
        double reach)
        : tau_(m.tau[impact + 1]),
          jump_(m.x_dot[impact + 1] - m.x_dot_before[impact]),
          gap_(m.gap[impact]),
          gap_error_(m.gap_error[impact]),
          gap_rate_(m.gap_rate[impact]) {
        const double tau = tau_;
        const auto first = std::lower_bound(r.tau.begin(), r.tau.end(), tau - reach),
                   last = std::upper_bound(r.tau.begin(), r.tau.end(), tau + reach);
        // The background runs through the impact but for its small step: half of each side's.
        for (auto it = first; it != last; ++it) {
            const auto k = static_cast<std::size_t>(it - r.tau.begin());
            const double s = *it - tau,
                         base = s < 0 ? m.x_ddot_before[impact] : m.x_ddot_after[impact];
            const double x_dot = s < 0 ? m.x_dot_before[impact] : m.x_dot[impact + 1];
            const double jerk = -x_dot - 2 * p.zeta() * base +
                                p.Omega * (m.force_sin * std::cos(p.Omega * tau) -
                                           m.force_cos * std::sin(p.Omega * tau));
            samples_.push_back({*it, r.x_ddot[k] - base - jerk * s});
        }
    }
    /// Sum of squares, in units of the noise: of the acceleration's samples, and of the gap between
    /// the intervals' own motions.
    double misfit(double tau, double pulse, double noise) const {
        const double gap = (gap_ + gap_rate_ * (tau - tau_)) / gap_error_;
        double sum = gap * gap;
        for (const auto& [at, value] : samples_) {
            const double d = (value - jump_ * pulse_shape(at - tau, pulse)) / noise;
            sum += d * d;
        }
        return sum;
    }

private:
    double tau_, jump_, gap_, gap_error_, gap_rate_;
    std::vector<std::pair<double, double>> samples_;
};

/// Kinks of x inside of intervals that one motion does not fit: impacts whose pulse no sample has
/// seen. One in each interval.
std::vector<Spike> find_kinks(
    const Parameters& p, const MeasuredRecord& r, const FittedMotion& m, double noise) {
    const Model model(p);
    std::vector<Spike> kinks;
    for (std::size_t i = 0; i < m.tau.size(); ++i) {
        const double begin = m.tau[i], end = i + 1 < m.tau.size() ? m.tau[i + 1] : r.tau.back();
        const auto first = static_cast<std::size_t>(
            std::lower_bound(r.tau.begin(), r.tau.end(), begin) - r.tau.begin());
        const std::size_t n = std::min(
            static_cast<std::size_t>(
                std::upper_bound(r.tau.begin(), r.tau.end(), end) - r.tau.begin()) -
                first,
            kink_window);
        if (n < 12) continue;
        // What is left of x in units of its noise, by a start of its own for these samples.
        Eigen::MatrixXd rows(n, 3);
        Eigen::VectorXd left(n);
        for (std::size_t k = 0; k < n; ++k) {
            const Rows at = model.at(begin, r.tau[first + k] - begin);
            rows.block<1, 2>(static_cast<Eigen::Index>(k), 0) = at.x.head<2>().transpose() / noise;
            left(static_cast<Eigen::Index>(k)) =
                (r.x[first + k] -
                 at.x.dot(Eigen::Vector4d(m.own_x[i], m.own_x_dot[i], m.force_sin, m.force_cos))) /
                noise;
        }
        const auto misfit = [&](Eigen::Index columns, Eigen::VectorXd* solution) {
            const Eigen::MatrixXd used = rows.leftCols(columns);
            const Eigen::VectorXd z =
                (used.transpose() * used).ldlt().solve(used.transpose() * left);
            if (solution) *solution = z;
            return (left - used * z).squaredNorm();
        };
        const double whole_misfit = misfit(2, nullptr);
        if (whole_misfit < unsuspicious_misfit(n)) continue;
        double least = whole_misfit, where = 0, jump = 0;
        for (std::size_t c = 3; c + 3 < n; ++c) {
            const double tau = 0.5 * (r.tau[first + c] + r.tau[first + c - 1]);
            for (std::size_t k = 0; k < n; ++k) {
                const double s = r.tau[first + k] - tau;
                rows(static_cast<Eigen::Index>(k), 2) =
                    s > 0 ? model.velocity_response(s) / noise : 0;
            }
            Eigen::VectorXd z;
            const double with_kink = misfit(3, &z);
            if (with_kink < least) least = with_kink, where = tau, jump = z(2);
        }
        if (whole_misfit - least > kink_sigmas * kink_sigmas)
            kinks.push_back({where, jump > 0 ? -1 : 1, jump, 0});
    }
    return kinks;
}

}  // namespace

namespace {

// A sample of the displacement this many standard deviations off the cubic through its neighbours
// is odd, unless the kink of an impact may put it there: two thirds of the jump times the step at
// most.
constexpr double odd_sigmas = 10, odd_jumps = 4;

double typical_jump(const std::vector<Spike>& spikes) {
    std::vector<double> jumps;
    for (const Spike& s : spikes) jumps.push_back(std::abs(s.jump));
    return spikes.empty() ? 0 : median(std::move(jumps));
}

/// Single samples of the displacement that are far off are replaced by the cubic through their
/// neighbours.
void mend_displacement(MeasuredRecord& r, double jump) {
    const std::size_t n = r.x.size();
    const double step = sample_interval(r);
    if (n < 5 || !(jump > 0)) return;
    std::vector<double> cubic(r.x), off(n, 0);
    for (std::size_t k = 2; k + 2 < n; ++k) {
        if (r.tau[k + 2] - r.tau[k - 2] > 6 * step) continue;
        const std::size_t at[4] = {k - 2, k - 1, k + 1, k + 2};
        double value = 0;
        for (std::size_t i : at) {
            double weight = 1;
            for (std::size_t j : at)
                if (j != i) weight *= (r.tau[k] - r.tau[j]) / (r.tau[i] - r.tau[j]);
            value += weight * r.x[i];
        }
        cubic[k] = value;
        off[k] = std::abs(r.x[k] - value);
    }
    const double limit = std::max(odd_sigmas * robust_deviation(off), odd_jumps * jump * step);
    for (std::size_t k = 2; k + 2 < n; ++k)
        if (off[k] > limit && off[k] >= std::max({off[k - 2], off[k - 1], off[k + 1], off[k + 2]}))
            r.x[k] = cubic[k];
}

/// Of two spikes of opposite sides in a time in which the mass could not fly from wall to wall,
/// even twenty times as fast as it typically is, one is no impact: that against which the velocity
/// jumps over both.
std::vector<char> impossible(
    const Parameters& p, const std::vector<Spike>& spikes, const FittedMotion& m) {
    const double least = 2 * p.b * p.epsilon / (20 * typical_jump(spikes));
    std::vector<char> bad(spikes.size(), 0);
    for (std::size_t i = 0; i + 1 < spikes.size(); ++i)
        if (spikes[i].side == -spikes[i + 1].side && spikes[i + 1].tau - spikes[i].tau < least) {
            const int side = m.x_dot[i + 2] > m.x_dot_before[i] ? -1 : 1;
            bad[spikes[i].side == side ? i + 1 : i] = 1;
        }
    return bad;
}

}  // namespace

RefinedImpacts refine_impacts(
    const Parameters& p, const MeasuredRecord& record, std::vector<Spike> spikes, double sigmas) {
    MeasuredRecord r = record;
    if (!r.x.empty()) mend_displacement(r, typical_jump(spikes));
    const double step = sample_interval(r), first_moment = r.tau.front() + 0.01 * step,
                 last_moment = r.tau.back() - 0.01 * step;
    RefinedImpacts refined{{}, {}, 0, {}, {}, true};
    auto fit = [&](double pulse) {
        refined.tau.clear(), refined.side.clear();
        std::sort(spikes.begin(), spikes.end(), [](const Spike& a, const Spike& b) {
            return a.tau < b.tau;
        });
        for (Spike& s : spikes) {
            s.tau = std::clamp(s.tau, first_moment, last_moment);
            refined.tau.push_back(s.tau);
            refined.side.push_back(s.side);
        }
        refined.pulse = pulse;
        refined.motion = fit_motion(p, r, refined.tau, pulse);
        for (std::size_t i = 0; i < spikes.size(); ++i) {
            if (spikes[i].side != 0) continue;  // one of which only the moment was given
            spikes[i].jump = refined.motion.x_dot[i + 1] - refined.motion.x_dot_before[i];
            spikes[i].side = refined.side[i] = spikes[i].jump > 0 ? -1 : 1;
        }
    };
    if (r.x_ddot.empty()) {
        fit(0);
        return refined;
    }
    fit(2 * step);
    // What comes back after it was dropped twice would do so for ever.
    struct Rejected {
        Spike spike;
        int times;
    };
    std::vector<Rejected> rejected;
    constexpr int rounds = 12, most_rejections = 2;
    for (int round = 0; round < rounds && !spikes.empty(); ++round) {
        const FittedMotion& motion = refined.motion;
        const double reach = std::max(1.5 * refined.pulse, 2.5 * step);
        std::vector<Around> around;
        for (std::size_t i = 0; i < spikes.size(); ++i) around.emplace_back(p, r, motion, i, reach);
        // The mean of all moments by their likelihood: a single sample in a short pulse leaves two
        // moments, before it and behind it.
        auto moment = [&](std::size_t i, double length, double& least) {
            const double centre = motion.tau[i + 1], width = std::max(step, 0.5 * length);
            constexpr int steps = 40;
            std::array<double, 2 * steps + 1> misfits;
            for (int k = -steps; k <= steps; ++k)
                misfits[k + steps] =
                    around[i].misfit(centre + width * k / steps, length, motion.noise_x_ddot);
            least = *std::min_element(misfits.begin(), misfits.end());
            double sum = 0, first = 0;
            for (int k = -steps; k <= steps; ++k) {
                const double likelihood = std::exp(-0.5 * (misfits[k + steps] - least));
                sum += likelihood;
                first += likelihood * width * k / steps;
            }
            return std::isfinite(first / sum) ? centre + first / sum : centre;
        };
        // One pulse length for the record: that with the smallest typical misfit. A few odd spikes
        // must not choose it.
        double least = infinity, pulse = refined.pulse;
        for (double length = std::min(0.3 * step, shortest_pulse);
             length < std::max(6 * step, longest_pulse); length *= pulse_ratio) {
            std::vector<double> misfits;
            for (std::size_t i = 0; i < spikes.size(); i += 1 + spikes.size() / 100) {
                double misfit;
                moment(i, length, misfit);
                misfits.push_back(misfit);
            }
            const double typical = median(misfits);
            if (typical < least) least = typical, pulse = length;
        }
        for (std::size_t i = 0; i < spikes.size(); ++i) {
            double misfit;
            spikes[i].tau = moment(i, pulse, misfit);
        }
        fit(pulse);
        // What is no impact has no jump, or one of the other sign: the foot of a long pulse, a bump
        // of the cable, an odd sample.
        const double noise =
            std::max(refined.motion.noise_x_ddot, background_share * robust_deviation(r.x_ddot));
        std::vector<Spike> seen = grouped(
                               r, refined.motion.left, noise, sigmas,
                               std::max(2 * pulse, 4 * step)),
                           kept;
        auto same = [&](const Spike& a, const Spike& b) {
            return std::abs(a.tau - b.tau) < 0.5 * (pulse + step) && a.side == b.side;
        };
        auto is_kept = [&](const Spike& s) {
            return std::any_of(
                kept.begin(), kept.end(), [&](const Spike& k) { return same(s, k); });
        };
        const std::vector<char> bad = sigmas > 0 ? impossible(p, spikes, refined.motion)
                                                 : std::vector<char>(spikes.size(), 0);
        for (std::size_t i = 0; i < spikes.size(); ++i) {
            const double jump = -spikes[i].side *
                                (refined.motion.x_dot[i + 1] - refined.motion.x_dot_before[i]),
                         error = refined.motion.jump_error[i];
            const bool as_its_spike = jump > least_jump * std::abs(spikes[i].jump);
            const bool visible = sigmas > 0
                                     ? std::any_of(
                                           seen.begin(), seen.end(),
                                           [&](const Spike& s) { return same(s, spikes[i]); })
                                     : as_its_spike;
            const bool certain = jump > kink_sigmas * error,
                       uncertain = 3 * error > std::abs(spikes[i].jump);
            if (!bad[i] && ((visible && (as_its_spike || (uncertain && jump > 0))) || certain)) {
                kept.push_back(spikes[i]);
                continue;
            }
            const auto before = std::find_if(
                rejected.begin(), rejected.end(),
                [&](const Rejected& d) { return same(d.spike, spikes[i]); });
            if (before == rejected.end()) rejected.push_back({spikes[i], 1});
            else if (++before->times == most_rejections) {
                // No impact, so an odd sample: the motion stands for it.
                for (std::size_t k = 0; k < r.tau.size(); ++k)
                    if (std::abs(r.tau[k] - spikes[i].tau) < step)
                        r.x_ddot[k] -= refined.motion.left[k];
            }
        }
        const bool none_dropped = kept.size() == spikes.size();
        std::size_t added = 0;
        if (sigmas > 0 && round + 1 < rounds) {
            std::vector<Spike> found = seen;
            if (!r.x.empty()) {
                const std::vector<Spike> kinks =
                    find_kinks(p, r, refined.motion, refined.motion.noise_x);
                found.insert(found.end(), kinks.begin(), kinks.end());
            }
            for (const Spike& s : found) {
                const bool hopeless =
                    std::any_of(rejected.begin(), rejected.end(), [&](const Rejected& d) {
                        return d.times >= most_rejections && same(d.spike, s);
                    });
                if (hopeless || is_kept(s)) continue;
                kept.push_back(s);
                ++added;
            }
        }
        spikes = std::move(kept);
        refined.settled = none_dropped && added == 0;
        if (refined.settled && round >= 2) break;
        if (!refined.settled) fit(pulse);  // what is returned belongs together, settled or not
    }
    for (const Rejected& d : rejected)
        if (std::none_of(spikes.begin(), spikes.end(), [&](const Spike& s) {
                return std::abs(s.tau - d.spike.tau) < step && s.side == d.spike.side;
            }))
            refined.dropped.push_back(d.spike);
    return refined;
}

FittedMotion direct_motion(
    const MeasuredRecord& r, const std::vector<double>& impacts, double pulse) {
    // Differences over this time: longer, and x'' changes; shorter, and the noise of x grows.
    constexpr double span = 0.2;
    FittedMotion m;
    m.tau = {r.tau.front()};
    m.tau.insert(m.tau.end(), impacts.begin(), impacts.end());
    m.x = {r.x.front()};
    m.x_dot = {nan};
    const auto last = static_cast<std::ptrdiff_t>(r.tau.size()) - 1;
    const auto sample = [&](double tau) {
        return std::lower_bound(r.tau.begin(), r.tau.end(), tau) - r.tau.begin();
    };
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        const double tau = impacts[i];
        // On each side the sample next to the pulse, and one about `span` away, but not beyond the
        // next impact's pulse.
        struct Side {
            double x, x_dot, x_ddot;
        };
        const auto estimate = [&](std::ptrdiff_t near, std::ptrdiff_t far) {
            near = std::clamp<std::ptrdiff_t>(near, 0, last);
            far = std::clamp<std::ptrdiff_t>(far, 0, last);
            const double a = r.tau[near], b = r.tau[far], x_ddot = r.x_ddot[near];
            const double x_dot =
                near == far ? nan
                            : (r.x[near] - r.x[far]) / (a - b) + x_ddot * (tau - 0.5 * (a + b));
            const double s = tau - a;
            return Side{r.x[near] + x_dot * s - 0.5 * x_ddot * s * s, x_dot, x_ddot};
        };
        const double earliest = i > 0 ? impacts[i - 1] + 0.5 * pulse : r.tau.front(),
                     latest = i + 1 < impacts.size() ? impacts[i + 1] - 0.5 * pulse : r.tau.back();
        const Side before = estimate(
            sample(tau - 0.5 * pulse) - 1, sample(std::max(earliest, tau - 0.5 * pulse - span)));
        const Side after = estimate(
            sample(tau + 0.5 * pulse), sample(std::min(latest, tau + 0.5 * pulse + span)) - 1);
        m.x.push_back(0.5 * (before.x + after.x));
        m.x_dot_before.push_back(before.x_dot);
        m.x_ddot_before.push_back(before.x_ddot);
        m.x_ddot_after.push_back(after.x_ddot);
        m.x_dot.push_back(after.x_dot);
    }
    return m;
}

namespace {

// A misfit of three quarters of the noise beside the noise: sqrt(1 + .75^2). Records with the
// assumed signal stay below 1.05.
constexpr double misfit_limit = 1.25;
// Where the impacts themselves do not agree on b to half of it, it is not their b.
constexpr double b_scatter = 0.5, b_tolerance = 0.03;

/// y' of each flight is offset - b rate: y = x - side b at both of its ends (43).
struct Flight {
    double offset, rate;
    double y_dot(double b) const { return offset - b * rate; }
};

/// x' + epsilon y' is kept at every impact, and y' is linear in b: the weighted median of what each
/// impact says.
void fit_b(
    const Parameters& p, const FittedMotion& m, const std::vector<Flight>& flights,
    Identification& found) {
    found.b_fitted = found.b_error = nan;
    std::vector<std::pair<double, double>> said;  // b, weight
    double total = 0, sum = 0;
    for (std::size_t i = 1; i < flights.size(); ++i) {
        const double rate = flights[i].rate - flights[i - 1].rate;
        const double b = ((m.x_dot[i + 1] - m.x_dot_before[i]) / p.epsilon + flights[i].offset -
                          flights[i - 1].offset) /
                         rate;
        if (!std::isfinite(b)) continue;
        said.emplace_back(b, std::abs(rate));
        total += std::abs(rate);
    }
    if (said.empty()) {
        found.b_fault = "no impact has one on the other wall before or after it";
        return;
    }
    std::sort(said.begin(), said.end());
    const auto middle = std::find_if(
        said.begin(), said.end(), [&](const auto& s) { return (sum += s.second) >= 0.5 * total; });
    const double b = middle == said.end() ? nan : middle->first;
    std::vector<double> off;
    for (const auto& s : said) off.push_back(s.first - b);
    const double scatter = robust_deviation(off);
    if (!explains(m)) found.b_fault = "the fitted motion does not explain the record";
    else if (!(b > 0)) found.b_fault = "it would be negative";
    else if (!(scatter < b_scatter * b)) found.b_fault = "the impacts say different ones";
    else
        found.b_fitted = b,
        found.b_error = 1.25 * scatter / std::sqrt(static_cast<double>(off.size()));
}

}  // namespace

bool explains(const FittedMotion& m) {
    return !(m.misfit_x > misfit_limit) && !(m.misfit_x_ddot > misfit_limit);
}

Identification identify_impacts(
    const Parameters& p, const FittedMotion& m, const std::vector<int>& sides, double pulse) {
    Identification found;
    const std::size_t n = sides.size();
    std::vector<Flight> flights;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const double duration = m.tau[i + 2] - m.tau[i + 1];
        flights.push_back(
            {(m.x[i + 2] - m.x[i + 1]) / duration, (sides[i + 1] - sides[i]) / duration});
    }
    for (std::size_t i = 0; i < n; ++i) {
        IdentifiedImpact impact{
            .tau = m.tau[i + 1],
            .side = sides[i],
            .x = m.x[i + 1],
            .x_dot_before = m.x_dot_before[i],
            .x_dot_after = m.x_dot[i + 1],
            .x_ddot_before = m.x_ddot_before[i]};
        if (i > 0) impact.y_dot_before = flights[i - 1].y_dot(p.b);
        if (i + 1 < n) impact.y_dot_after = flights[i].y_dot(p.b);
        found.impacts.push_back(std::move(impact));
    }
    complete_impacts(p, found.impacts, pulse);
    found.plus = restitution_of(found.impacts, 1);
    found.minus = restitution_of(found.impacts, -1);

    fit_b(p, m, flights, found);
    return found;
}

bool b_agrees(const Parameters& p, const Identification& i) {
    return !std::isfinite(i.b_fitted) ||
           std::abs(i.b_fitted - p.b) <= std::max(b_tolerance * p.b, 5 * i.b_error);
}

std::vector<std::string> doubts_of(
    const Parameters& p, const RefinedImpacts& refined, const Identification& identification) {
    std::vector<std::string> doubts;
    if (!refined.settled)
        doubts.push_back(
            "the search for impacts did not settle: what one round finds the next one drops");
    if (!explains(refined.motion))
        doubts.push_back(
            "the fitted motion does not explain the record: it leaves more than the noise of the "
            "sensors (signal.misfit). Is a parameter wrong (frequency, mass, stiffness), or has a "
            "sensor an offset, a drift, a delay or another scale?");
    if (!b_agrees(p, identification))
        doubts.push_back("the impacts' momentum does not fit the given b");
    return doubts;
}

}  // namespace vines
