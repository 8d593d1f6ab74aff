#include "core/measurement/measured_load.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/motion/elementary.hpp"

namespace vines {

namespace {

using Complex = std::complex<double>;

constexpr std::size_t most_harmonics = 5;
// Harmonics below this fraction of the channel's sampling rate are fitted.
constexpr double most_of_rate = 0.4;
// Shortest pieces of a spline, in cycles, those of the drift, and their largest number.
constexpr double shortest_piece = 3, drift_piece = 10, most_pieces = 512;
// Noise below this fraction of the amplitude is assumed in the choice of a spline: numerical errors
// are no modulation.
constexpr double least_noise = 1e-3;
// Penalty of a parameter in Akaike's criterion.
constexpr double akaike = 2;
// Fits of all harmonics after the choice.
constexpr int passes = 2;
// Weight of the second differences of a spline's coefficients, relative to the samples: bridges
// gaps of the channel.
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
class EnvelopeFit {
public:
    EnvelopeFit(
        const ForcingChannel& channel, const Harmonic& sine, const std::function<void()>& look)
        : channel_(channel),
          look_(look),
          Omega_(sine.omega),
          length_(channel.end - channel.begin),
          floor_(least_noise * least_noise * (sine.sin * sine.sin + sine.cos * sine.cos)),
          left_(channel.values) {}

    /// Fits harmonic k with this many coefficients to what the others leave.
    Envelope fitted(std::size_t k, std::size_t coefficients) {
        look_();
        equations_.setZero(2 * coefficients);
        for (std::size_t n = 0; n < left_.size(); ++n)
            equations_.add(row_at(n, k, coefficients), left_[n]);
        return equations_.solved();
    }
    /// Adds `sign` times a harmonic to what is left.
    void add(std::size_t k, const Envelope& e, double sign) {
        if (e.coefficients.empty()) return;
        for (std::size_t n = 0; n < left_.size(); ++n) {
            const Row row = row_at(n, k, e.coefficients.size());
            for (std::size_t j = 0; j < row.count; ++j)
                left_[n] += sign * (row.by[j] * e.coefficients[row.first + j]).real();
        }
    }
    /// The best envelope among numbers of coefficients; 0: none. Bayes' criterion decides whether
    /// it varies, Akaike's then how much: too few pieces are worse than noise.
    Envelope best(std::size_t k, const std::vector<std::size_t>& choices) {
        const double n = static_cast<double>(left_.size());
        double all = 0;
        for (const double v : left_) all += v * v;
        std::vector<Envelope> envelopes;
        std::vector<double> misfit;
        for (const std::size_t coefficients : choices) {
            envelopes.push_back(coefficients > 0 ? fitted(k, coefficients) : Envelope{});
            const double squares = coefficients > 0 ? all - equations_.explained : all;
            misfit.push_back(n * elementary::log(std::max(squares, 0.0) / n + floor_));
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
    double noise() const {
        double sum = 0;
        for (const double v : left_) sum += v * v;
        return std::sqrt(sum / static_cast<double>(left_.size()));
    }

private:
    /// A sample is the real part of the sum of `by` times coefficients.
    struct Row {
        std::size_t first, count;
        std::array<Complex, 4> by;
    };
    /// Normal equations: the coefficients' real and imaginary parts, in a band.
    struct Equations {
        std::vector<std::array<double, 8>> band;  ///< entries (j, j - n), n < 8
        std::vector<double> right;
        double explained = 0;  ///< decrease of the sum of squares

        void setZero(std::size_t size) {
            band.assign(size, {});
            right.assign(size, 0);
        }
        void add(const Row& row, double value) {
            std::array<double, 8> by{};
            for (std::size_t j = 0; j < row.count; ++j)
                by[2 * j] = row.by[j].real(), by[2 * j + 1] = -row.by[j].imag();
            for (std::size_t a = 0; a < 2 * row.count; ++a) {
                right[2 * row.first + a] += by[a] * value;
                for (std::size_t b = 0; b <= a; ++b)
                    band[2 * row.first + a][a - b] += by[a] * by[b];
            }
        }
        Envelope solved() {
            double largest = 0;
            for (const auto& row : band) largest = std::max(largest, row[0]);
            const double weight = bridging * largest;
            // (c_j - 2 c_(j+1) + c_(j+2))^2, for both parts.
            for (std::size_t j = 4; j < band.size(); ++j) {
                band[j][0] += weight, band[j - 2][0] += 4 * weight, band[j - 4][0] += weight;
                band[j][2] -= 2 * weight, band[j - 2][2] -= 2 * weight, band[j][4] += weight;
            }
            std::vector<Eigen::Triplet<double>> entries;
            for (std::size_t j = 0; j < band.size(); ++j) {
                band[j][0] += 1e-12 * largest;
                for (std::size_t n = 0; n < 8 && n <= j; ++n)
                    entries.emplace_back(j, j - n, band[j][n]);
            }
            const auto size = static_cast<Eigen::Index>(band.size());
            Eigen::SparseMatrix<double> N(size, size);
            N.setFromTriplets(entries.begin(), entries.end());
            const Eigen::Map<const Eigen::VectorXd> g(right.data(), size);
            const Eigen::VectorXd c =
                Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>>(N).solve(g);
            explained = c.dot(g);
            Envelope e;
            for (Eigen::Index j = 0; j < size; j += 2) e.coefficients.emplace_back(c(j), c(j + 1));
            return e;
        }
    };

    Row row_at(std::size_t n, std::size_t k, std::size_t coefficients) const {
        const double tau = channel_.tau[n], omega = static_cast<double>(k) * Omega_,
                     sigma = tau - 0.5 * (channel_.begin + channel_.end), by_tau = 1 / length_;
        const SplineRow s = spline_row(coefficients, (tau - channel_.begin) * by_tau);
        Row row{s.first, s.count, {}};
        const Complex phasor = elementary::phasor(omega * sigma);
        for (std::size_t j = 0; j < s.count; ++j)
            row.by[j] =
                phasor * (k == 0 || channel_.kind != ForcingKind::base_acceleration
                              ? s.value[j]
                              : Complex(
                                    s.second[j] * by_tau * by_tau - omega * omega * s.value[j],
                                    2 * omega * s.rate[j] * by_tau));
        return row;
    }

    const ForcingChannel& channel_;
    const std::function<void()>& look_;
    const double Omega_, length_, floor_;
    std::vector<double> left_;
    Equations equations_;
};

/// Numbers of coefficients to choose from: a constant, and splines with pieces of `shortest` cycles
/// or more.
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

Complex Envelope::at(double u) const {
    const SplineRow row = spline_row(coefficients.size(), u);
    Complex sum = 0;
    for (std::size_t j = 0; j < row.count; ++j) sum += row.value[j] * coefficients[row.first + j];
    return sum;
}

std::shared_ptr<const MeasuredLoad> MeasuredLoad::of(
    const ForcingChannel& channel, const Harmonic& sine, const std::function<void()>& look) {
    const double length = channel.end - channel.begin,
                 cycles = length * sine.omega / (2 * std::numbers::pi),
                 rate = static_cast<double>(channel.tau.size() - 1) /
                        (channel.tau.back() - channel.tau.front());
    EnvelopeFit fit(channel, sine, look);
    const std::vector<std::size_t> choices = choices_for(cycles, shortest_piece);
    // The offset and its drift are not part of the load. Without the sine they are small.
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
    if (all.size() < 2 || (all.size() == 2 && !all[1].varies())) return nullptr;
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
    const double samples = static_cast<double>(channel.tau.size());
    load.noise_ = fit.noise() * std::sqrt(2 / samples) / elementary::hypot(sine.sin, sine.cos);
    for (std::size_t k = 1; k < all.size(); ++k) {
        // The base acts through spring and damper.
        const Complex by_base(
            1, channel.kind == ForcingKind::force
                   ? 0
                   : static_cast<double>(k) * sine.omega * channel.damping);
        for (Complex& c : all[k].coefficients) c *= by_base;
        if (k == 1) load.fundamental = mean_envelope(all[1]);
        for (Complex& c : all[k].coefficients) c /= load.fundamental;
        load.harmonics_.push_back(std::move(all[k]));
    }
    return std::make_shared<const MeasuredLoad>(std::move(load));
}

double MeasuredLoad::lead(const UnknownValues& v) const {
    const Complex z = Complex(v[Unknown::force_cos], -v[Unknown::force_sin]) / fundamental;
    return std::remainder(elementary::atan2(z.imag(), z.real()), std::numbers::pi);
}

Complex MeasuredLoad::excess(double sigma, const UnknownValues& values) const {
    const double u = 0.5 + sigma / length_;
    const Complex phasor = elementary::phasor(values[Unknown::Omega] * sigma),
                  turned = phasor * elementary::phasor(lead(values));
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
    return noise_ / (kind_ == ForcingKind::base_acceleration ? static_cast<double>(k * k) : 1);
}

LoadResponse::Excess::Excess(const MeasuredLoad& load, const UnknownValues& values) {
    const double cells = std::ceil((load.length() + 2 * margin_tau) / cell_tau);
    begin = -0.5 * load.length() - margin_tau;
    step = (load.length() + 2 * margin_tau) / cells;
    for (std::size_t n = 0; n <= 2 * static_cast<std::size_t>(cells); ++n)
        at.push_back(load.excess(begin + 0.5 * step * static_cast<double>(n), values));
}

/// Runge-Kutta steps of fourth order.
LoadResponse::LoadResponse(const Excess& excess, double k, double c, double by)
    : begin_(excess.begin),
      step_(excess.step) {
    Complex x = 0, v = 0;
    const double h = step_;
    for (std::size_t n = 0; n < excess.at.size(); n += 2) {
        const auto rate = [&](std::size_t at, Complex x_at, Complex v_at) {
            return by * excess.at[at] - k * x_at - c * v_at;
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
    const double at = std::clamp(
                     (sigma - begin_) / step_, 0.0, static_cast<double>(nodes_.size() - 1)),
                 cell = std::min(std::floor(at), static_cast<double>(nodes_.size() - 2)),
                 t = at - cell, h = step_;
    const Motion &from = nodes_[static_cast<std::size_t>(cell)],
                 &to = nodes_[static_cast<std::size_t>(cell) + 1];
    const Complex v = h * from.x_dot, a = h * h * from.x_ddot, x_off = to.x - from.x - v - 0.5 * a,
                  v_off = h * to.x_dot - v - a, a_off = h * h * to.x_ddot - a,
                  c3 = 10.0 * x_off - 4.0 * v_off + 0.5 * a_off,
                  c4 = -15.0 * x_off + 7.0 * v_off - a_off,
                  c5 = 6.0 * x_off - 3.0 * v_off + 0.5 * a_off;
    return {
        from.x + t * (v + t * (0.5 * a + t * (c3 + t * (c4 + t * c5)))),
        (v + t * (a + t * (3.0 * c3 + t * (4.0 * c4 + t * (5.0 * c5))))) / h,
        (a + t * (6.0 * c3 + t * (12.0 * c4 + t * (20.0 * c5)))) / (h * h)};
}

}  // namespace vines
