#include "core/measurement/measured_load.hpp"

#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/measurement/robust.hpp"

namespace vines {

namespace {

using Complex = std::complex<double>;

double squares_of(const std::vector<double>& values) {
    return std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
}

// A channel is periodic if it has this many cycles, and a sine explains this share of its variance.
constexpr double fewest_cycles = 5, least_explained = 0.75;
// A crossing counts once the signal passes the mean by this fraction of its standard deviation.
constexpr double hysteresis = 0.5;
// The crossings give the frequency to about one crossing in the whole record. Pieces of this many
// cycles resolve the remaining phase drift; pieces that grow refine it, as long as there are four.
constexpr double cycles_of_piece = 4, growth = 4, fewest_pieces = 4;
constexpr int refinements = 6;

/// Angular frequency from the upward crossings of the mean; 0 with too few. Intervals that miss
/// one, as in a gap, are left out.
double rough_omega(
    const std::vector<double>& time, const std::vector<double>& values, double mean, double level) {
    std::vector<double> crossings, intervals;
    bool is_low = false;
    for (std::size_t k = 0; k < values.size(); ++k) {
        if (values[k] < mean - level) is_low = true;
        if (!is_low || values[k] < mean + level) continue;
        is_low = false;
        if (!crossings.empty()) intervals.push_back(time[k] - crossings.back());
        crossings.push_back(time[k]);
    }
    if (count_of(intervals) < fewest_cycles) return 0;
    double cycles = count_of(intervals), duration = crossings.back() - crossings.front();
    const double longest = 1.5 * median(intervals);
    for (const double interval : intervals)
        if (interval > longest) --cycles, duration -= interval;
    return cycles < fewest_cycles ? 0 : 2 * std::numbers::pi * cycles / duration;
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
    double last = 0, unwrapped = 0;
    double n = 0, t = 0, a = 0, tt = 0, ta = 0;  // sums for a straight line through the phases
    for (std::size_t from = 0; from < time.size();) {
        std::size_t to = from + 1;
        while (to < time.size() && time[to] < time[from] + piece) ++to;
        // A piece that the end or a gap cuts short is left out: it has no phase.
        if (to == time.size() && from > 0) break;
        const std::size_t first = std::exchange(from, to);
        if (time[to - 1] - time[first] < 0.5 * piece) continue;
        const HarmonicFit f = fit_harmonic(time, values, omega, first, to);
        const double angle = elementary::atan2(f.by(1), f.by(0));
        if (n > 0) unwrapped += std::remainder(angle - last, 2 * std::numbers::pi);
        else unwrapped = angle;
        last = angle;
        const double middle = 0.5 * (time[first] + time[to - 1]);
        n += 1, t += middle, a += unwrapped, tt += middle * middle, ta += middle * unwrapped;
    }
    return n > 1 ? (n * ta - t * a) / (n * tt - t * t) : 0;
}

constexpr std::size_t most_harmonics = 5;
// Harmonics below this fraction of the channel's sampling rate are fitted.
constexpr double most_of_rate = 0.4;
// Shortest pieces of a spline in cycles, of a harmonic and of the drift; the largest number of
// them.
constexpr double shortest_piece = 3, drift_piece = 10, most_pieces = 512;
// Least noise in the choice of a spline, over the amplitude: numerical errors are no modulation.
constexpr double least_noise = 1e-3;
constexpr double akaike = 2;  // penalty of a parameter in Akaike's criterion
constexpr int passes = 2;     // fits of all harmonics after the choice
// Weight of a spline's second differences, relative to the samples: bridges gaps of the channel.
constexpr double bridging = 1e-6;
// Cell of a response, tau, and its margin beyond the record, which exceeds any delay.
constexpr double cell_tau = 0.1, margin_tau = 1;

/// B-splines at a time, with derivatives by u.
struct SplineRow {
    std::size_t first, count;
    std::array<double, 4> value, rate, second;
};

SplineRow spline_row(std::size_t coefficients, double u) {
    if (coefficients == 1) return {0, 1, {1}, {0}, {0}};
    const double pieces = static_cast<double>(coefficients - 3),
                 at = std::clamp(u * pieces, 0.0, pieces),
                 cell = std::min(std::floor(at), pieces - 1), t = at - cell, s = 1 - t,
                 square = pieces * pieces;
    return {
        static_cast<std::size_t>(cell),
        4,
        {s * s * s / 6, ((3 * t - 6) * t * t + 4) / 6, (((3 - 3 * t) * t + 3) * t + 1) / 6,
         t * t * t / 6},
        {-pieces * s * s / 2, pieces * (3 * t - 4) * t / 2, pieces * ((2 - 3 * t) * t + 1) / 2,
         pieces * t * t / 2},
        {square * s, square * (3 * t - 2), square * (1 - 3 * t), square * t}};
}

/// Fits envelopes to a channel, harmonic by harmonic.
struct EnvelopeFit {
    const ForcingChannel& channel;
    const Harmonic& sine;
    const Look& look;
    const double length = channel.end - channel.begin;
    std::vector<double> left = channel.values;  ///< what the harmonics leave of the channel
    double explained = 0;                       ///< decrease of its squares by the last fit

    /// Harmonic k at sample n: the real part of the sum of `by` times coefficients. The envelope is
    /// that of the force or of the base; a channel of its acceleration has the second derivative.
    struct Row {
        std::size_t first, count;
        std::array<Complex, 4> by;
    };
    Row row_at(std::size_t n, std::size_t k, std::size_t coefficients) const {
        const double tau = channel.tau[n], omega = static_cast<double>(k) * sine.omega,
                     sigma = tau - 0.5 * (channel.begin + channel.end), by_tau = 1 / length;
        const SplineRow s = spline_row(coefficients, (tau - channel.begin) * by_tau);
        Row row{s.first, s.count, {}};
        const Complex phasor = elementary::phasor(omega * sigma);
        for (std::size_t j = 0; j < s.count; ++j)
            row.by[j] =
                phasor * (k == 0 || channel.kind != LoadKind::base_acceleration
                              ? s.value[j]
                              : Complex(
                                    s.second[j] * by_tau * by_tau - omega * omega * s.value[j],
                                    2 * omega * s.rate[j] * by_tau));
        return row;
    }

    /// Fits harmonic k with this many coefficients to what the others leave.
    Envelope fitted(std::size_t k, std::size_t coefficients) {
        look();
        // Normal equations of the coefficients' real and imaginary parts: entries (j, j - n).
        std::vector<std::array<double, 8>> band(2 * coefficients, std::array<double, 8>{});
        Eigen::VectorXd right = Eigen::VectorXd::Zero(2 * coefficients);
        for (std::size_t n = 0; n < left.size(); ++n) {
            const Row row = row_at(n, k, coefficients);
            std::array<double, 8> by{};
            for (std::size_t j = 0; j < row.count; ++j)
                by[2 * j] = row.by[j].real(), by[2 * j + 1] = -row.by[j].imag();
            for (std::size_t a = 0; a < 2 * row.count; ++a) {
                right[2 * row.first + a] += by[a] * left[n];
                for (std::size_t b = 0; b <= a; ++b)
                    band[2 * row.first + a][a - b] += by[a] * by[b];
            }
        }
        // Arrays compare by their first entries, on the diagonal.
        const double largest = std::ranges::max(band)[0], weight = bridging * largest;
        // (c_j - 2 c_(j+1) + c_(j+2))^2, for both parts.
        for (std::size_t j = 4; j < band.size(); ++j) {
            band[j][0] += weight, band[j - 2][0] += 4 * weight, band[j - 4][0] += weight;
            band[j][2] -= 2 * weight, band[j - 2][2] -= 2 * weight, band[j][4] += weight;
        }
        std::vector<Eigen::Triplet<double>> entries;
        for (std::size_t j = 0; j < band.size(); ++j) {
            band[j][0] += 1e-12 * largest;  // not singular in a gap
            for (std::size_t n = 0; n < 8 && n <= j; ++n)
                entries.emplace_back(j, j - n, band[j][n]);
        }
        Eigen::SparseMatrix<double> N(right.size(), right.size());
        N.setFromTriplets(entries.begin(), entries.end());
        const Eigen::VectorXd c =
            Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(N).solve(right);
        explained = c.dot(right);
        Envelope e;
        for (Eigen::Index j = 0; j < c.size(); j += 2) e.coefficients.emplace_back(c(j), c(j + 1));
        return e;
    }
    /// Adds `sign` times a harmonic to what is left.
    void add(std::size_t k, const Envelope& e, double sign) {
        if (e.coefficients.empty()) return;
        for (std::size_t n = 0; n < left.size(); ++n) {
            const Row row = row_at(n, k, e.coefficients.size());
            for (std::size_t j = 0; j < row.count; ++j)
                left[n] += sign * (row.by[j] * e.coefficients[row.first + j]).real();
        }
    }
    /// The best envelope among numbers of (complex) coefficients; 0: none. Bayes' criterion decides
    /// whether it varies, Akaike's, which permits more, how fast: too few are worse than noise.
    Envelope best(std::size_t k, const std::vector<std::size_t>& choices) {
        const double n = count_of(left), all = squares_of(left),
                     floor =
                         least_noise * least_noise * (sine.sin * sine.sin + sine.cos * sine.cos);
        std::vector<Envelope> envelopes;
        std::vector<double> misfit;
        for (const std::size_t coefficients : choices) {
            envelopes.push_back(coefficients > 0 ? fitted(k, coefficients) : Envelope{});
            const double squares = coefficients > 0 ? all - explained : all;
            misfit.push_back(n * elementary::log(std::max(squares, 0.0) / n + floor));
        }
        const auto least = [&](double penalty) {
            const auto criterion = [&](std::size_t i) {
                return misfit[i] + 2 * penalty * static_cast<double>(choices[i]);
            };
            std::size_t chosen = 0;
            for (std::size_t i = 1; i < choices.size(); ++i)
                if (criterion(i) < criterion(chosen)) chosen = i;
            return chosen;
        };
        const std::size_t chosen = least(elementary::log(n));
        return envelopes[envelopes[chosen].varies() ? least(akaike) : chosen];
    }
};

/// Numbers of coefficients: of a constant, and of splines with pieces of `shortest` cycles or more.
std::vector<std::size_t> choices_for(double cycles, double shortest) {
    std::vector<std::size_t> all = {1};
    for (double pieces = 1; pieces <= std::min(most_pieces, cycles / shortest); pieces *= 2)
        all.push_back(static_cast<std::size_t>(pieces) + 3);
    return all;
}

/// Mean modulus and phase.
Complex mean_envelope(const Envelope& e) {
    const std::size_t points = 4 * e.coefficients.size();
    Complex sum = 0;
    double moduli = 0;
    for (std::size_t n = 0; n < points; ++n) {
        const Complex c = e.at((static_cast<double>(n) + 0.5) / static_cast<double>(points));
        sum += c, moduli += elementary::modulus(c);
    }
    return sum / elementary::modulus(sum) * (moduli / static_cast<double>(points));
}

}  // namespace

std::optional<Harmonic> harmonic_of(
    const std::vector<double>& time, const std::vector<double>& values, const Look& look) {
    const double n = count_of(values),
                 mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    std::vector<double> about(values);
    for (double& v : about) v -= mean;
    const double deviation = std::sqrt(squares_of(about) / n);
    double omega = rough_omega(time, values, mean, hysteresis * deviation);
    if (!(omega > 0) || !std::isfinite(omega)) return std::nullopt;
    const double duration = time.back() - time.front();
    double piece = cycles_of_piece * 2 * std::numbers::pi / omega;
    for (int k = 0; k < refinements; ++k) {
        look();
        omega += omega_off(time, about, omega, piece);
        if (piece * growth < duration / fewest_pieces) piece *= growth;
    }
    const HarmonicFit all = fit_harmonic(time, about, omega, 0, time.size());
    if (!(all.squares < (1 - least_explained) * n * deviation * deviation)) return std::nullopt;
    return Harmonic{omega, all.by(0), all.by(1)};
}

Complex Envelope::at(double u) const {
    const SplineRow row = spline_row(coefficients.size(), u);
    Complex sum = 0;
    for (std::size_t j = 0; j < row.count; ++j) sum += row.value[j] * coefficients[row.first + j];
    return sum;
}

std::shared_ptr<const MeasuredLoad> MeasuredLoad::of(
    const ForcingChannel& channel, const Harmonic& sine, const Look& look) {
    const double length = channel.end - channel.begin,
                 cycles = length * sine.omega / (2 * std::numbers::pi),
                 rate = (count_of(channel.tau) - 1) / (channel.tau.back() - channel.tau.front());
    EnvelopeFit fit{channel, sine, look};
    const std::vector<std::size_t> choices = choices_for(cycles, shortest_piece);
    // The offset and its drift are no load: what a constant sine leaves, smoothed, is removed.
    const Envelope constant = fit.fitted(1, 1);
    fit.add(1, constant, -1);
    std::vector<Envelope> all = {fit.fitted(0, choices_for(cycles, drift_piece).back())};
    fit.add(0, all[0], -1);
    fit.add(1, constant, 1);
    for (std::size_t k = 1; k <= most_harmonics && static_cast<double>(k) * sine.omega <
                                                       2 * std::numbers::pi * most_of_rate * rate;
         ++k) {
        all.push_back(fit.best(
            k, k == 1 ? choices : std::vector<std::size_t>{0, 1, all[1].coefficients.size()}));
        fit.add(k, all[k], -1);
    }
    while (all.size() > 2 && all.back().coefficients.empty()) all.pop_back();
    if (all.size() < 2 || (all.size() == 2 && !all[1].varies())) return nullptr;  // a sine
    // Again, since the harmonics are not quite independent of each other.
    for (int pass = 0; pass < passes; ++pass)
        for (std::size_t k = 0; k < all.size(); ++k) {
            if (all[k].coefficients.empty()) continue;
            fit.add(k, all[k], 1);
            all[k] = fit.fitted(k, all[k].coefficients.size());
            fit.add(k, all[k], -1);
        }
    MeasuredLoad load;
    load.Omega = sine.omega, load.length_ = length, load.kind_ = channel.kind;
    const double samples = count_of(channel.tau), noise = std::sqrt(squares_of(fit.left) / samples);
    load.noise_ = noise * std::sqrt(2 / samples) / elementary::hypot(sine.sin, sine.cos);
    for (std::size_t k = 1; k < all.size(); ++k) {
        // The base acts through spring and damper.
        const Complex by_base(
            1, channel.kind == LoadKind::force
                   ? 0
                   : static_cast<double>(k) * sine.omega * channel.damping);
        for (Complex& c : all[k].coefficients) c *= by_base;
        if (k == 1) load.fundamental = mean_envelope(all[1]);
        for (Complex& c : all[k].coefficients) c /= load.fundamental;
        load.harmonics_.push_back(std::move(all[k]));
    }
    return std::make_shared<const MeasuredLoad>(std::move(load));
}

Complex MeasuredLoad::excess(double sigma, const UnknownValues& v) const {
    const Complex z = Complex(v[Unknown::force_cos], -v[Unknown::force_sin]) / fundamental;
    // Lead of the fitted fundamental over that of the channel, which can be inverted: modulo pi.
    const double lead = std::remainder(elementary::atan2(z.imag(), z.real()), std::numbers::pi),
                 u = 0.5 + sigma / length_;
    const Complex phasor = elementary::phasor(v[Unknown::Omega] * sigma),
                  turned = phasor * elementary::phasor(lead);
    Complex sum = phasor * (harmonics_[0].at(u) - 1.0), of_harmonic = phasor;
    for (std::size_t k = 1; k < harmonics_.size(); ++k) {
        of_harmonic *= turned;
        if (!harmonics_[k].coefficients.empty()) sum += of_harmonic * harmonics_[k].at(u);
    }
    return sum;
}

double MeasuredLoad::error_of(std::size_t k) const {
    if (k > harmonics_.size() || harmonics_[k - 1].coefficients.empty() ||
        (k == 1 && !harmonics_[0].varies()))
        return 0;
    return noise_ / (kind_ == LoadKind::base_acceleration ? static_cast<double>(k * k) : 1);
}

LoadResponse::Excess::Excess(const MeasuredLoad& load, const UnknownValues& values) {
    const double cells = std::ceil((load.length() + 2 * margin_tau) / cell_tau);
    begin = -0.5 * load.length() - margin_tau;
    step = (load.length() + 2 * margin_tau) / cells;
    for (std::size_t n = 0; n <= 2 * static_cast<std::size_t>(cells); ++n)
        at.push_back(load.excess(begin + 0.5 * step * static_cast<double>(n), values));
}

/// x'' + damping x' + stiffness x = by_force excess from rest, by Runge-Kutta steps of fourth
/// order.
LoadResponse::LoadResponse(const Excess& excess, double stiffness, double damping, double by_force)
    : begin_(excess.begin),
      step_(excess.step) {
    Complex x = 0, v = 0;
    const double h = step_;
    for (std::size_t n = 0; n < excess.at.size(); n += 2) {
        const auto rate = [&](std::size_t i, Complex x_at, Complex v_at) {
            return by_force * excess.at[i] - stiffness * x_at - damping * v_at;
        };
        const Complex a1 = rate(n, x, v);
        nodes_.push_back({x, v, a1});
        if (n + 2 >= excess.at.size()) break;
        const Complex v2 = v + 0.5 * h * a1, a2 = rate(n + 1, x + 0.5 * h * v, v2),
                      v3 = v + 0.5 * h * a2, a3 = rate(n + 1, x + 0.5 * h * v2, v3),
                      v4 = v + h * a3, a4 = rate(n + 2, x + h * v3, v4);
        x += h / 6 * (v + 2.0 * v2 + 2.0 * v3 + v4);
        v += h / 6 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
    }
}

/// The polynomial of degree 5 through both states of a cell and their accelerations.
LoadResponse::Motion LoadResponse::at(double sigma) const {
    const double place = std::clamp(
                     (sigma - begin_) / step_, 0.0, static_cast<double>(nodes_.size() - 1)),
                 cell = std::min(std::floor(place), static_cast<double>(nodes_.size() - 2)),
                 t = place - cell, h = step_;
    const Node &from = nodes_[static_cast<std::size_t>(cell)],
               &to = nodes_[static_cast<std::size_t>(cell) + 1];
    const Complex v = h * from.x_dot, a = h * h * from.x_ddot, x_off = to.x - from.x - v - 0.5 * a,
                  v_off = h * to.x_dot - v - a, a_off = h * h * to.x_ddot - a,
                  c3 = 10.0 * x_off - 4.0 * v_off + 0.5 * a_off,
                  c4 = -15.0 * x_off + 7.0 * v_off - a_off,
                  c5 = 6.0 * x_off - 3.0 * v_off + 0.5 * a_off;
    const Complex x = from.x + t * (v + t * (0.5 * a + t * (c3 + t * (c4 + t * c5)))),
                  x_dot = (v + t * (a + t * (3.0 * c3 + t * (4.0 * c4 + t * (5.0 * c5))))) / h,
                  x_ddot = (a + t * (6.0 * c3 + t * (12.0 * c4 + t * (20.0 * c5)))) / (h * h);
    return {{x.imag(), x_dot.imag(), x_ddot.imag()}, {x.real(), x_dot.real(), x_ddot.real()}};
}

}  // namespace vines
