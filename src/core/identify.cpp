#include "core/identify.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace vines {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

double median(std::vector<double> v) {
    if (v.empty()) return nan;
    const auto middle = v.begin() + static_cast<std::ptrdiff_t>(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    return *middle;
}

/// Standard deviation of the bulk, whatever the outliers.
double robust_deviation(std::vector<double> v) {
    for (double& x : v) x = std::abs(x);
    return 1.4826 * median(std::move(v));
}

/// Noise of a smooth signal from its third differences, whose variance is 20 times that of the noise.
double noise_of(const std::vector<double>& v) {
    std::vector<double> third;
    for (std::size_t i = 3; i < v.size(); ++i) third.push_back(v[i] - 3 * v[i - 1] + 3 * v[i - 2] - v[i - 3]);
    return robust_deviation(std::move(third)) / std::sqrt(20.0);
}

double sample_interval(const MeasuredRecord& r) { return (r.tau.back() - r.tau.front()) / static_cast<double>(r.tau.size() - 1); }

// Pulses of impacts between hard bodies last .2 to 2 ms; at an oscillator of 8 Hz that is .01 to .1 in tau.
constexpr double shortest_pulse = 0.005, longest_pulse = 0.15;
// A jump of x' without a spike is an impact only beyond this many standard errors. It is looked for in so many samples at once.
constexpr double kink_sigmas = 7;
constexpr std::size_t kink_window = 400;
// The jump of a real impact is the area of its spike; noise and few samples leave that much of it.
constexpr double least_jump = 0.25;

// The background of the acceleration is a sine of about the frequency 1 (in tau): over +-.25 a parabola fits it to 2e-4. It
// takes at least 9 samples on each side, of which pulses may cover half.
constexpr double background_least = 0.25;
constexpr int background_samples = 9;
// A record with hardly any noise shows what the parabola, or a frequency that is a little off, leaves of the sine: no spike is
// smaller than some times this share of it.
constexpr double background_share = 1e-3;

/// What is left of the acceleration without its smooth background: a parabola through the unmasked neighbours of each sample.
std::vector<double> without_background(const MeasuredRecord& r, const std::vector<char>& masked, double background) {
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

/// Neighbouring samples of one sign above the noise are one spike, unless they last longer than `longest`.
std::vector<Spike> grouped(const MeasuredRecord& r, const std::vector<double>& left, double noise, double sigmas, double longest) {
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
        if (height > sigmas * noise && r.tau[j - 1] - r.tau[k] < longest) spikes.push_back({moment / area, sign > 0 ? -1 : 1, area, height / noise});
        k = j;
    }
    return spikes;
}

}  // namespace

Spikes find_spikes(const MeasuredRecord& r, double sigmas) {
    const std::size_t n = r.tau.size();
    const double background = std::max(background_least, background_samples * sample_interval(r));
    Spikes found{{}, noise_of(r.x_ddot)};
    // First what stands out from the median of its neighbourhood; then, again and again, from the parabola through the rest.
    std::vector<char> masked(n, 0);
    std::vector<double> left(n), window;
    for (std::size_t k = 0, from = 0, to = 0; k < n; ++k) {
        while (r.tau[k] - r.tau[from] > background) ++from;
        while (to < n && r.tau[to] - r.tau[k] <= background) ++to;
        window.assign(r.x_ddot.begin() + static_cast<std::ptrdiff_t>(from), r.x_ddot.begin() + static_cast<std::ptrdiff_t>(to));
        left[k] = r.x_ddot[k] - median(window);
    }
    const double coarse = std::max(found.noise, robust_deviation(left));
    for (std::size_t k = 0; k < n; ++k) masked[k] = std::abs(left[k]) > 4 * coarse;
    for (int round = 0; round < 8; ++round) {
        left = without_background(r, masked, background);
        std::vector<double> quiet;
        for (std::size_t k = 0; k < n; ++k) if (!masked[k]) quiet.push_back(left[k]);
        found.noise = robust_deviation(quiet);
        std::vector<char> next(n, 0);
        for (std::size_t k = 0; k < n; ++k)
            if (std::abs(left[k]) > 4 * found.noise)
                for (std::size_t j = k > 0 ? k - 1 : 0; j <= std::min(k + 1, n - 1); ++j) next[j] = 1;
        if (next == masked) break;
        masked = std::move(next);
    }
    found.noise = std::max(found.noise, background_share * robust_deviation(r.x_ddot));
    found.spikes = grouped(r, left, found.noise, sigmas, std::numeric_limits<double>::infinity());
    return found;
}

namespace {

/// x, x' and x'' of the linear model at a time s after an interval's start: their derivatives by x, x' there and by the two
/// parts of the forcing.
struct Rows {
    Eigen::Vector4d x, x_dot, x_ddot;
};

class Model {
public:
    explicit Model(const Parameters& p) : damping_(2 * p.zeta()), Omega_(p.Omega), flow_(1, 2 * p.zeta(), 1, p.Omega) {}

    Rows at(double tau, double s) const {
        const double sin = std::sin(Omega_ * tau), cos = std::cos(Omega_ * tau);
        const Oscillation parts[4] = {flow_.after({1, 0, 0, 0}, s), flow_.after({0, 1, 0, 0}, s), flow_.after({0, 0, sin, cos}, s), flow_.after({0, 0, cos, -sin}, s)};
        Rows rows;
        for (int k = 0; k < 4; ++k) {
            rows.x(k) = parts[k].x;
            rows.x_dot(k) = parts[k].x_dot;
            rows.x_ddot(k) = -parts[k].x - damping_ * parts[k].x_dot + (k >= 2 ? parts[k].sin_theta : 0);
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
    explicit Equations(std::size_t intervals) : unknowns_(static_cast<Eigen::Index>(2 * intervals + 2)), right_(Eigen::VectorXd::Zero(unknowns_)) {}

    /// The normal matrix and right side of interval i's samples, by its start and the forcing.
    void add(std::size_t i, const Eigen::Matrix4d& N, const Eigen::Vector4d& g) {
        const Eigen::Index at[4] = {static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * i + 1), unknowns_ - 2, unknowns_ - 1};
        for (int j = 0; j < 4; ++j) {
            right_(at[j]) += g(j);
            for (int k = 0; k < 4; ++k) triplets_.emplace_back(at[j], at[k], N(j, k));
        }
    }
    /// x at the end of interval i (row) is x at the start of the next.
    void connect(std::size_t i, const Eigen::Vector4d& row, double weight) {
        Eigen::Matrix<double, 5, 1> all;
        all << row, -1;
        const Eigen::Index at[5] = {static_cast<Eigen::Index>(2 * i), static_cast<Eigen::Index>(2 * i + 1), unknowns_ - 2, unknowns_ - 1, static_cast<Eigen::Index>(2 * i + 2)};
        for (int j = 0; j < 5; ++j)
            for (int k = 0; k < 5; ++k) triplets_.emplace_back(at[j], at[k], weight * weight * all(j) * all(k));
    }
    Eigen::VectorXd solve() {
        // An interval without a sample, or a record that does not show the forcing, leaves its unknowns at zero.
        for (Eigen::Index k = 0; k < unknowns_; ++k) triplets_.emplace_back(k, k, 1e-9);
        Eigen::SparseMatrix<double> N(unknowns_, unknowns_);
        N.setFromTriplets(triplets_.begin(), triplets_.end());
        const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(N);
        return solver.solve(right_);
    }

private:
    const Eigen::Index unknowns_;
    std::vector<Eigen::Triplet<double>> triplets_;
    Eigen::VectorXd right_;
};

/// Half a sine of area 1 and length `pulse` about 0.
double pulse_shape(double s, double pulse) {
    return std::abs(s) < 0.5 * pulse ? 0.5 * std::numbers::pi / pulse * std::cos(std::numbers::pi * s / pulse) : 0;
}

}  // namespace

FittedMotion fit_motion(const Parameters& p, const MeasuredRecord& r, const std::vector<double>& impacts, double pulse) {
    const Model model(p);
    FittedMotion m;
    m.tau = {r.tau.front()};
    m.tau.insert(m.tau.end(), impacts.begin(), impacts.end());
    const std::size_t n = m.tau.size();
    const double guard = 0.5 * pulse + 0.1 * sample_interval(r);  // the pulse spoils the acceleration on both sides of an impact
    const double sigma_x = r.x.empty() ? nan : std::max(noise_of(r.x), 1e-12), sigma_a = r.x_ddot.empty() ? nan : std::max(noise_of(r.x_ddot), 1e-12);
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
        const bool spike = (i > 0 && r.tau[k] - m.tau[i] < guard) || (i + 1 < n && m.tau[i + 1] - r.tau[k] < guard);
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
    const double sigma_c = 0.05 * (r.x.empty() ? sigma_a : sigma_x);
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
        covariance.push_back((N[k].topLeftCorner<2, 2>() + 1e-9 * Eigen::Matrix2d::Identity()).inverse());
        const Eigen::Vector2d own = covariance[k] * (g[k].head<2>() - N[k].topRightCorner<2, 2>() * force);
        m.own_x.push_back(own(0));
        m.own_x_dot.push_back(own(1));
    }
    const auto start = [&](double x, double x_dot) { return Eigen::Vector4d(x, x_dot, force(0), force(1)); };
    // An interval with hardly a sample says nothing.
    const auto error = [](double variance) { return variance > 0 ? std::sqrt(variance) : std::numeric_limits<double>::infinity(); };
    for (std::size_t k = 0; k + 1 < n; ++k) {
        const Eigen::Vector4d before = start(m.x[k], m.x_dot[k]), own = start(m.own_x[k], m.own_x_dot[k]);
        m.x_dot_before.push_back(ends[k].x_dot.dot(before));
        m.x_ddot_before.push_back(ends[k].x_ddot.dot(before));
        m.x_ddot_after.push_back(model.at(m.tau[k + 1], 0).x_ddot.dot(start(m.x[k + 1], m.x_dot[k + 1])));
        m.gap.push_back(ends[k].x.dot(own) - m.own_x[k + 1]);
        m.gap_rate.push_back(ends[k].x_dot.dot(own) - m.own_x_dot[k + 1]);
        const Eigen::Vector2d row = ends[k].x.head<2>(), speed = ends[k].x_dot.head<2>();
        m.gap_error.push_back(error(row.dot(covariance[k] * row) + covariance[k + 1](0, 0)));
        m.jump_error.push_back(error(speed.dot(covariance[k] * speed) + covariance[k + 1](1, 1)));
    }

    std::vector<double> left_x, left_a;
    for (std::size_t k = 0; k < samples.size(); ++k) {
        const Sample& s = samples[k];
        const Eigen::Vector4d from = start(m.x[s.interval], m.x_dot[s.interval]);
        if (!r.x.empty()) left_x.push_back(r.x[k] - s.x.dot(from));
        if (r.x_ddot.empty()) continue;
        m.left.push_back(r.x_ddot[k] - s.x_ddot.dot(from));
        if (!s.spike) left_a.push_back(m.left.back());
    }
    m.noise_x = r.x.empty() ? nan : robust_deviation(left_x);
    m.noise_x_ddot = r.x_ddot.empty() ? nan : robust_deviation(left_a);
    return m;
}

namespace {

/// What is left of the acceleration around an impact, and how well a moment and a pulse length explain it.
class Around {
public:
    Around(const Parameters& p, const MeasuredRecord& r, const FittedMotion& m, std::size_t impact, double reach)
        : tau_(m.tau[impact + 1]), jump_(m.x_dot[impact + 1] - m.x_dot_before[impact]), gap_(m.gap[impact]), gap_error_(m.gap_error[impact]), gap_rate_(m.gap_rate[impact]) {
        const double tau = tau_;
        const auto first = std::lower_bound(r.tau.begin(), r.tau.end(), tau - reach), last = std::upper_bound(r.tau.begin(), r.tau.end(), tau + reach);
        // The background runs through the impact but for its small step: half of each side's.
        for (auto it = first; it != last; ++it) {
            const auto k = static_cast<std::size_t>(it - r.tau.begin());
            const double s = *it - tau, base = s < 0 ? m.x_ddot_before[impact] : m.x_ddot_after[impact];
            const double x_dot = s < 0 ? m.x_dot_before[impact] : m.x_dot[impact + 1];
            const double jerk = -x_dot - 2 * p.zeta() * base + p.Omega * (m.force_sin * std::cos(p.Omega * tau) - m.force_cos * std::sin(p.Omega * tau));
            samples_.push_back({*it, r.x_ddot[k] - base - jerk * s});
        }
    }
    /// Sum of squares, in units of the noise: of the acceleration's samples, and of the gap between the intervals' own motions.
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

/// Kinks of x inside of intervals that one motion does not fit: impacts whose pulse no sample has seen. One in each interval.
std::vector<Spike> find_kinks(const Parameters& p, const MeasuredRecord& r, const FittedMotion& m, double noise) {
    const Model model(p);
    std::vector<Spike> kinks;
    for (std::size_t i = 0; i < m.tau.size(); ++i) {
        const double begin = m.tau[i], end = i + 1 < m.tau.size() ? m.tau[i + 1] : r.tau.back();
        const auto first = static_cast<std::size_t>(std::lower_bound(r.tau.begin(), r.tau.end(), begin) - r.tau.begin());
        const std::size_t n = std::min(static_cast<std::size_t>(std::upper_bound(r.tau.begin(), r.tau.end(), end) - r.tau.begin()) - first, kink_window);
        if (n < 12) continue;
        // What is left of x in units of its noise, by a start of its own for these samples.
        Eigen::MatrixXd rows(n, 3);
        Eigen::VectorXd left(n);
        for (std::size_t k = 0; k < n; ++k) {
            const Rows at = model.at(begin, r.tau[first + k] - begin);
            rows.block<1, 2>(static_cast<Eigen::Index>(k), 0) = at.x.head<2>().transpose() / noise;
            left(static_cast<Eigen::Index>(k)) = (r.x[first + k] - at.x.dot(Eigen::Vector4d(m.own_x[i], m.own_x_dot[i], m.force_sin, m.force_cos))) / noise;
        }
        const auto misfit = [&](Eigen::Index columns, Eigen::VectorXd* solution) {
            const Eigen::MatrixXd used = rows.leftCols(columns);
            const Eigen::VectorXd z = (used.transpose() * used).ldlt().solve(used.transpose() * left);
            if (solution) *solution = z;
            return (left - used * z).squaredNorm();
        };
        const double whole_misfit = misfit(2, nullptr);
        if (whole_misfit < 1.3 * static_cast<double>(n) + 10) continue;
        double least = whole_misfit, where = 0, jump = 0;
        for (std::size_t c = 3; c + 3 < n; ++c) {
            const double tau = 0.5 * (r.tau[first + c] + r.tau[first + c - 1]);
            for (std::size_t k = 0; k < n; ++k) {
                const double s = r.tau[first + k] - tau;
                rows(static_cast<Eigen::Index>(k), 2) = s > 0 ? model.velocity_response(s) / noise : 0;
            }
            Eigen::VectorXd z;
            const double with_kink = misfit(3, &z);
            if (with_kink < least) least = with_kink, where = tau, jump = z(2);
        }
        if (whole_misfit - least > kink_sigmas * kink_sigmas) kinks.push_back({where, jump > 0 ? -1 : 1, jump, 0});
    }
    return kinks;
}

}  // namespace

RefinedImpacts refine_impacts(const Parameters& p, const MeasuredRecord& r, std::vector<Spike> spikes, double sigmas) {
    const double step = sample_interval(r), first_moment = r.tau.front() + 0.01 * step, last_moment = r.tau.back() - 0.01 * step;
    RefinedImpacts refined{{}, {}, 0, {}, {}};
    auto fit = [&](double pulse) {
        refined.tau.clear(), refined.side.clear();
        std::sort(spikes.begin(), spikes.end(), [](const Spike& a, const Spike& b) { return a.tau < b.tau; });
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
    constexpr int rounds = 10;
    for (int round = 0; round < rounds && !spikes.empty(); ++round) {
        const FittedMotion& motion = refined.motion;
        const double reach = std::max(1.5 * refined.pulse, 2.5 * step);
        std::vector<Around> around;
        for (std::size_t i = 0; i < spikes.size(); ++i) around.emplace_back(p, r, motion, i, reach);
        // The mean of all moments by their likelihood: a single sample in a short pulse leaves two moments, before it and behind it.
        auto moment = [&](std::size_t i, double length, double& least) {
            const double centre = motion.tau[i + 1], width = std::max(step, 0.5 * length);
            constexpr int steps = 40;
            std::array<double, 2 * steps + 1> misfits;
            for (int k = -steps; k <= steps; ++k) misfits[k + steps] = around[i].misfit(centre + width * k / steps, length, motion.noise_x_ddot);
            least = *std::min_element(misfits.begin(), misfits.end());
            double sum = 0, first = 0;
            for (int k = -steps; k <= steps; ++k) {
                const double likelihood = std::exp(-0.5 * (misfits[k + steps] - least));
                sum += likelihood;
                first += likelihood * width * k / steps;
            }
            return std::isfinite(first / sum) ? centre + first / sum : centre;
        };
        // One pulse length for the record: that with the smallest typical misfit. A few odd spikes must not choose it.
        double least = std::numeric_limits<double>::infinity(), pulse = refined.pulse;
        for (double length = std::min(0.3 * step, shortest_pulse); length < std::max(6 * step, longest_pulse); length *= 1.06) {
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
        // What is no impact has no jump, or one of the other sign: the foot of a long pulse, a bump of the cable.
        const double noise = std::max(refined.motion.noise_x_ddot, background_share * robust_deviation(r.x_ddot));
        std::vector<Spike> seen = grouped(r, refined.motion.left, noise, sigmas, std::max(2 * pulse, 4 * step)), kept;
        auto same = [&](const Spike& a, const Spike& b) { return std::abs(a.tau - b.tau) < 0.5 * (pulse + step) && a.side == b.side; };
        for (std::size_t i = 0; i < spikes.size(); ++i) {
            const double jump = -spikes[i].side * (refined.motion.x_dot[i + 1] - refined.motion.x_dot_before[i]);
            const bool visible = sigmas > 0 ? std::any_of(seen.begin(), seen.end(), [&](const Spike& s) { return same(s, spikes[i]); }) : jump > least_jump * std::abs(spikes[i].jump);
            const bool certain = jump > kink_sigmas * refined.motion.jump_error[i];
            ((visible && jump > 0) || certain ? kept : refined.dropped).push_back(spikes[i]);
        }
        if (sigmas > 0 && round + 1 < rounds) {
            const std::size_t known = kept.size();
            for (const Spike& s : seen)
                if (std::none_of(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(known), [&](const Spike& k) { return same(s, k); })) kept.push_back(s);
            if (!r.x.empty()) {
                const std::vector<Spike> kinks = find_kinks(p, r, refined.motion, refined.motion.noise_x);
                kept.insert(kept.end(), kinks.begin(), kinks.end());
            }
        }
        const bool settled = kept.size() == spikes.size();
        spikes = std::move(kept);
        if (!settled) fit(pulse);
        if (settled && round >= 2) break;
    }
    return refined;
}

FittedMotion direct_motion(const MeasuredRecord& r, const std::vector<double>& impacts, double pulse) {
    // Differences over this time: longer, and x'' changes; shorter, and the noise of x grows.
    constexpr double span = 0.2;
    FittedMotion m;
    m.tau = {r.tau.front()};
    m.tau.insert(m.tau.end(), impacts.begin(), impacts.end());
    m.x = {r.x.front()};
    m.x_dot = {nan};
    const auto last = static_cast<std::ptrdiff_t>(r.tau.size()) - 1;
    const auto sample = [&](double tau) { return std::lower_bound(r.tau.begin(), r.tau.end(), tau) - r.tau.begin(); };
    for (std::size_t i = 0; i < impacts.size(); ++i) {
        const double tau = impacts[i];
        // On each side the sample next to the pulse, and one about `span` away, but not beyond the next impact's pulse.
        struct Side {
            double x, x_dot, x_ddot;
        };
        const auto estimate = [&](std::ptrdiff_t near, std::ptrdiff_t far) {
            near = std::clamp<std::ptrdiff_t>(near, 0, last);
            far = std::clamp<std::ptrdiff_t>(far, 0, last);
            const double a = r.tau[near], b = r.tau[far], x_ddot = r.x_ddot[near];
            const double x_dot = near == far ? nan : (r.x[near] - r.x[far]) / (a - b) + x_ddot * (tau - 0.5 * (a + b));
            const double s = tau - a;
            return Side{r.x[near] + x_dot * s - 0.5 * x_ddot * s * s, x_dot, x_ddot};
        };
        const double earliest = i > 0 ? impacts[i - 1] + 0.5 * pulse : r.tau.front(), latest = i + 1 < impacts.size() ? impacts[i + 1] - 0.5 * pulse : r.tau.back();
        const Side before = estimate(sample(tau - 0.5 * pulse) - 1, sample(std::max(earliest, tau - 0.5 * pulse - span)));
        const Side after = estimate(sample(tau + 0.5 * pulse), sample(std::min(latest, tau + 0.5 * pulse + span)) - 1);
        m.x.push_back(0.5 * (before.x + after.x));
        m.x_dot_before.push_back(before.x_dot);
        m.x_ddot_before.push_back(before.x_ddot);
        m.x_ddot_after.push_back(after.x_ddot);
        m.x_dot.push_back(after.x_dot);
    }
    return m;
}

namespace {

// What an impact of a real measurement may miss R in [0, 1] and the balance of momentum by, before it is left out.
constexpr double R_tolerance = 0.15, momentum_tolerance = 0.35;

std::string fault_of(const IdentifiedImpact& i, double before, double pulse) {
    if (before < pulse) return "closer to the impact before it than the length of a pulse: one spike picked twice?";
    if (!std::isnan(i.y_dot_before) && !(i.side * (i.x_dot_before - i.y_dot_before) > 0)) return "the mass would move away from the wall that it meets: is an impact beside it missing, or b wrong?";
    if (std::isnan(i.x_dot_before) || std::isnan(i.x_dot_after)) return "too few samples beside it for a velocity";
    if (std::isnan(i.R)) return "";  // the first and the last: the flight on one side is not known, and R with it
    if (i.R < -R_tolerance || i.R > 1 + R_tolerance) return "R lies outside [0, 1]: is an impact beside it missing, or b wrong?";
    if (!(std::abs(i.momentum_error) < momentum_tolerance)) return "momentum is not kept: is an impact beside it missing or false, or b wrong?";
    return "";
}

}  // namespace

Restitution restitution_of(const std::vector<IdentifiedImpact>& impacts, int side) {
    std::vector<double> R, off;
    for (const IdentifiedImpact& i : impacts) if (i.side == side && i.fault.empty() && !std::isnan(i.R)) R.push_back(i.R);
    const double centre = median(R);
    for (double r : R) off.push_back(r - centre);
    // The median of n values scatters by 1.25 times what their mean would.
    return {centre, 1.25 * robust_deviation(off) / std::sqrt(static_cast<double>(R.size())), static_cast<long>(R.size())};
}

Identification identify_impacts(const Parameters& p, const FittedMotion& m, const std::vector<int>& sides, double pulse) {
    Identification found;
    const std::size_t n = sides.size();
    // y' of each flight is offset - b rate: y = x - side b at both of its ends (43).
    struct Flight {
        double offset, rate;
        double y_dot(double b) const { return offset - b * rate; }
    };
    std::vector<Flight> flights;
    for (std::size_t i = 0; i + 1 < n; ++i) {
        const double duration = m.tau[i + 2] - m.tau[i + 1];
        flights.push_back({(m.x[i + 2] - m.x[i + 1]) / duration, (sides[i + 1] - sides[i]) / duration});
    }
    std::vector<double> jumps;
    for (std::size_t i = 0; i < n; ++i) jumps.push_back(std::abs(m.x_dot[i + 1] - m.x_dot_before[i]));
    const double typical = median(jumps);
    for (std::size_t i = 0; i < n; ++i) {
        IdentifiedImpact impact{m.tau[i + 1], sides[i], m.x[i + 1], m.x_dot_before[i], m.x_dot[i + 1], m.x_ddot_before[i], nan, nan, nan, nan, ""};
        if (i > 0) impact.y_dot_before = flights[i - 1].y_dot(p.b);
        if (i + 1 < n) impact.y_dot_after = flights[i].y_dot(p.b);
        impact.R = -(impact.x_dot_after - impact.y_dot_after) / (impact.x_dot_before - impact.y_dot_before);
        impact.momentum_error = (impact.x_dot_after - impact.x_dot_before + p.epsilon * (impact.y_dot_after - impact.y_dot_before)) / typical;
        impact.fault = fault_of(impact, i > 0 ? m.tau[i + 1] - m.tau[i] : std::numeric_limits<double>::infinity(), pulse);
        found.impacts.push_back(std::move(impact));
    }
    found.plus = restitution_of(found.impacts, 1);
    found.minus = restitution_of(found.impacts, -1);

    // x' + epsilon y' is kept at every impact, and y' is linear in b: the weighted median of what each impact says.
    std::vector<std::pair<double, double>> said;  // b, weight
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double rate = flights[i].rate - flights[i - 1].rate;
        if (rate == 0) continue;
        said.emplace_back(((m.x_dot[i + 1] - m.x_dot_before[i]) / p.epsilon + flights[i].offset - flights[i - 1].offset) / rate, std::abs(rate));
    }
    std::sort(said.begin(), said.end());
    double total = 0, sum = 0;
    for (const auto& [b, weight] : said) total += weight;
    found.b_fitted = found.b_error = nan;
    for (const auto& [b, weight] : said)
        if ((sum += weight) >= 0.5 * total) {
            found.b_fitted = b;
            break;
        }
    std::vector<double> off;
    for (const auto& [b, weight] : said) off.push_back(b - found.b_fitted);
    if (!off.empty()) found.b_error = 1.25 * robust_deviation(off) / std::sqrt(static_cast<double>(off.size()));
    return found;
}

void append_identified(const Parameters& p, const Identification& identification, TransferProduct& product) {
    const Flow flow = Flow::free(p);
    for (const IdentifiedImpact& i : identification.impacts) {
        if (!i.fault.empty()) continue;
        if (product.impacts() == 0) {
            product.start(i.tau);
            continue;
        }
        if (std::isnan(i.y_dot_before)) continue;
        Impact impact{};
        impact.R = p.restitution(i.side);
        impact.relative_speed_before = i.x_dot_before - i.y_dot_before;
        impact.x_ddot_before = i.x_ddot_before;
        const Leg flight = leg_of(flow, i.tau - product.end_tau(), false);
        product.append({&flight, 1}, saltation(p, impact), impact.R, i.tau);
    }
}

IdentifiedExponents judge_exponents(const Parameters& p, const ExponentHistory& qr, double tau_start) {
    std::vector<double> log, duration;  // growth from impact to impact, without the first tenth
    for (std::size_t i = 1 + qr.tau.size() / 10; i < qr.tau.size(); ++i) {
        duration.push_back(qr.tau[i] - qr.tau[i - 1]);
        log.push_back(qr.lambda[i][0] * (qr.tau[i] - tau_start) - qr.lambda[i - 1][0] * (qr.tau[i - 1] - tau_start));
    }
    IdentifiedExponents e{nan, nan, nan, Verdict::not_decided};
    const std::size_t n = log.size();
    if (n < 20) return e;
    double sum = 0, time = 0;
    for (std::size_t i = 0; i < n; ++i) sum += log[i], time += duration[i];
    e.slope = sum / time;
    // Blocks as long as the memory of the motion, some impacts, drawn anew a thousand times; always the same ones.
    const auto block = static_cast<std::size_t>(std::clamp(std::cbrt(static_cast<double>(n)) * 2, 4.0, 20.0));
    std::mt19937_64 engine(2018);
    std::vector<double> slopes;
    for (int draw = 0; draw < 1000; ++draw) {
        double s = 0, t = 0;
        for (std::size_t got = 0; got < n; got += block) {
            const std::size_t from = engine() % (n - block + 1);
            for (std::size_t i = from; i < from + block; ++i) s += log[i], t += duration[i];
        }
        slopes.push_back(s / t);
    }
    std::sort(slopes.begin(), slopes.end());
    e.low = slopes[50], e.high = slopes[949];
    if (e.low > p.zeta()) e.verdict = Verdict::chaotic;
    if (e.high < p.zeta()) e.verdict = Verdict::regular;
    return e;
}

}  // namespace vines
