#include "core/motion/load.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "core/motion/fourier.hpp"

namespace vines {

namespace {

/// Length of a piece of a formula in units of 1/Omega, at most of tau: 14 Taylor coefficients are
/// exact to 1e-17, if the damping is not larger. The last piece is up to half longer.
constexpr double formula_step = 0.3, longest_formula_step = 1.5 * formula_step;

/// Taylor polynomial of amplitude sin(theta): z = exp(i theta) has z' = i theta' z.
Polynomial sine(double amplitude, const Polynomial& theta) {
    std::array<std::complex<double>, Polynomial::most> z;
    z[0] = {elementary::cos(theta[0]), elementary::sin(theta[0])};
    Polynomial p;
    for (int n = 0; n < Polynomial::most; ++n) {
        if (n > 0) {
            std::complex<double> of_rate = 0;
            for (int k = 1; k <= n && k < theta.size; ++k)
                of_rate += k * theta[k] * z[static_cast<std::size_t>(n - k)];
            z[static_cast<std::size_t>(n)] = {-of_rate.imag() / n, of_rate.real() / n};
        }
        p.add(n, amplitude * z[static_cast<std::size_t>(n)].imag());
    }
    return p;
}

/// A base that is accelerated piece by piece.
struct BaseMotion {
    long double x = 0, v = 0;

    /// Its displacement over the next h.
    Polynomial advance(const Polynomial& acceleration, double h) {
        Polynomial p;
        for (int n = 0; n < acceleration.size && n + 2 < Polynomial::most; ++n)
            p.add(n + 2, acceleration[n] / ((n + 1) * (n + 2)));
        const double by_x = p.at(h), by_v = p.rate(h);
        p.add(0, static_cast<double>(x));
        p.add(1, static_cast<double>(v));
        x += v * h + by_x;
        v += by_v;
        return p;
    }
};

/// The cubic from one node to another, a time h later.
Polynomial cubic(const LoadNode& from, const LoadNode& to, double h) {
    const double mean = (to.value - from.value) / h;
    return {
        from.value, from.rate, (3 * mean - 2 * from.rate - to.rate) / h,
        (from.rate + to.rate - 2 * mean) / (h * h)};
}

/// A base coasts or stays at the value `last`, a force ends.
Polynomial after_end(LoadKind kind, const BaseMotion& motion, const Polynomial& last) {
    if (kind == LoadKind::base_displacement) return last;
    if (kind == LoadKind::force) return {0};
    return {static_cast<double>(motion.x), static_cast<double>(motion.v)};
}

}  // namespace

Load::Load(LoadKind kind, const std::vector<double>& tau, const std::vector<double>& values)
    : kind_(kind),
      width_(kind == LoadKind::base_acceleration ? 4 : 2) {
    BaseMotion motion;
    for (std::size_t i = 0; i + 1 < tau.size(); ++i) {
        const double h = tau[i + 1] - tau[i];
        const Polynomial chord{values[i], (values[i + 1] - values[i]) / h};
        add_piece(tau[i], kind == LoadKind::base_acceleration ? motion.advance(chord, h) : chord);
    }
    add_piece(tau.back(), after_end(kind, motion, {values.back()}));
}

Load::Load(std::vector<LoadHarmonic> harmonics)
    : kind_(LoadKind::base_displacement),
      harmonics_(std::move(harmonics)) {
    double fastest = 1;
    for (const LoadHarmonic& h : harmonics_) fastest = std::max(fastest, h.Omega);
    harmonic_step_ = formula_step / fastest;
}

Load::Load(
    LoadKind kind, double amplitude, double duration,
    const std::function<Polynomial(double tau)>& theta)
    : kind_(kind),
      width_(Polynomial::most) {
    BaseMotion motion;
    Polynomial value;
    for (double tau = 0; tau < duration;) {
        const Polynomial angle = theta(tau);
        double next = tau + formula_step / std::max(1.0, std::abs(angle[1]));
        if (next + 0.5 * (next - tau) > duration) next = duration;
        value = sine(amplitude, angle);
        add_piece(
            tau, kind == LoadKind::base_acceleration ? motion.advance(value, next - tau) : value);
        if (next == duration) value = {value.at(next - tau)};
        tau = next;
    }
    add_piece(duration, after_end(kind, motion, value));
}

Load::Load(double step, const std::vector<LoadNode>& nodes) : kind_(LoadKind::force), width_(4) {
    for (std::size_t n = 0; n + 1 < nodes.size(); ++n)
        add_piece(step * static_cast<double>(n), cubic(nodes[n], nodes[n + 1], step));
    add_piece(step * static_cast<double>(nodes.size() - 1), {0});
}

double Load::response_reach(double damping) const {
    const bool is_formula = !harmonics_.empty() || width_ == Polynomial::most;
    return is_formula ? longest_formula_step / std::max(1.0, damping) : infinity;
}

std::pair<std::size_t, std::size_t> Load::noise_lines(
    double Omega_low, double Omega_high, double duration) {
    constexpr double rounding = 1e-12;
    const double lines = duration / (2 * std::numbers::pi);
    return {
        static_cast<std::size_t>(std::max(1.0, std::ceil(Omega_low * lines * (1 - rounding)))),
        static_cast<std::size_t>(Omega_high * lines * (1 + rounding))};
}

/// The acceleration is the real part of the sum of C_k exp(i w_k tau), w_k = 2 pi k/duration. The
/// base moves from rest and back to rest if the sum of B_k/w_k is zero, C_k = A_k - i B_k. Between
/// equidistant times it follows the cubic through both displacements and velocities.
Load Load::noise(
    double rms, double Omega_low, double Omega_high, double duration, std::uint64_t seed) {
    const double w1 = 2 * std::numbers::pi / duration;
    const auto [first, last] = noise_lines(Omega_low, Omega_high, duration);
    std::mt19937_64 engine(seed);
    Signal C(last + 1);
    double drift = 0, weight = 0, square = 0;
    const auto w = [w1](std::size_t k) { return w1 * static_cast<double>(k); };
    for (std::size_t k = first; k <= last; ++k) {
        const double A = standard_normal(engine);
        C[k] = {A, -standard_normal(engine)};
        drift += C[k].imag() / w(k), weight += 1 / (w(k) * w(k));
    }
    for (std::size_t k = first; k <= last; ++k) {
        C[k] -= std::complex<double>(0, drift / (weight * w(k)));
        square += 0.5 * std::norm(C[k]);
    }
    std::size_t N = 32;
    while (N < 32 * last) N *= 2;
    // Both real signals by one transform: p + i q.
    Signal motion(N), second(N);
    double place = 0;
    for (std::size_t k = first; k <= last; ++k) {
        C[k] *= rms / std::sqrt(square);
        const std::complex<double> i(0, 1), p = -C[k] / (w(k) * w(k)), q = -i * C[k] / w(k);
        motion[k] = 0.5 * (p + i * q);
        motion[N - k] = 0.5 * (std::conj(p) + i * std::conj(q));
        second[k] = C[k] * (w(k) * w(k));
        place -= p.real();
    }
    motion = fourier_sums(std::move(motion), 1), second = fourier_sums(std::move(second), 1);
    Load load(LoadKind::base_acceleration);
    load.width_ = 4;
    const double h = duration / static_cast<double>(N);
    double largest = 0;
    for (std::size_t n = 0; n < N; ++n) {
        const auto from = motion[n], to = motion[(n + 1) % N];
        Polynomial piece = cubic({from.real(), from.imag()}, {to.real(), to.imag()}, h);
        piece.c[0] += place;
        load.add_piece(h * static_cast<double>(n), piece);
        largest = std::max(largest, std::abs(second[n].real()));
    }
    load.add_piece(duration, {place + motion[0].real()});
    // Ehlich and Zeller's bound by the values at N points, and the error h^4/384 of a cubic.
    largest /=
        elementary::cos(std::numbers::pi * static_cast<double>(last) / static_cast<double>(N));
    load.sampling_error_ = largest * h * h * h * h / 384;
    return load;
}

void Load::add_piece(double tau, const Polynomial& piece) {
    tau_.push_back(tau);
    pieces_.insert(
        pieces_.end(), piece.c.begin(), piece.c.begin() + static_cast<std::ptrdiff_t>(width_));
}

std::size_t Load::interval_at(double tau) const {
    if (!harmonics_.empty()) return static_cast<std::size_t>(tau / harmonic_step_);
    const auto after = std::ranges::upper_bound(tau_, tau);
    return after == tau_.begin() ? 0 : static_cast<std::size_t>(after - tau_.begin()) - 1;
}

/// The base or the force by the time since `from`.
Polynomial Load::piece(std::size_t interval, double from) const {
    Polynomial p;
    for (const LoadHarmonic& h : harmonics_) {
        const long double phase = static_cast<long double>(h.Omega) * from + h.phase,
                          turn = 2 * std::numbers::pi_v<long double>;
        p =
            sum(p, sine(
                       h.amplitude,
                       {static_cast<double>(phase - turn * std::floor(phase / turn)), h.Omega}));
    }
    if (!harmonics_.empty()) return p;
    for (std::size_t n = 0; n < width_; ++n)
        if (const double value = pieces_[interval * width_ + n]; value != 0)
            p.add(static_cast<int>(n), value);
    return p.about(from - tau_[interval]);
}

Polynomial Load::base(std::size_t interval, double from) const {
    return moves_base() ? piece(interval, from) : Polynomial{};
}

Polynomial Load::force(std::size_t interval, double from, double damping) const {
    const Polynomial p = piece(interval, from);
    return moves_base() ? sum(p, p.derivative(), damping) : p;
}

double Load::largest_base_displacement(double until) const {
    double largest = 0;
    for (const LoadHarmonic& h : harmonics_) largest += std::abs(h.amplitude);
    if (!harmonics_.empty() || !moves_base()) return largest;
    for (std::size_t i = 0; i < tau_.size() && tau_[i] <= until; ++i)
        largest = std::max(largest, std::abs(pieces_[i * width_]));
    return std::max(largest, std::abs(base(interval_at(until), until)[0]));
}

Polynomial response(const Flow& flow, const Polynomial& force) {
    const double k = flow.coefficients()[0], d = flow.damping();
    Polynomial p;
    if (force.size <= 4) {
        for (int n = force.size - 1; n >= 0; --n)
            p.add(n, (force[n] - (n + 1) * (d * p[n + 1] + (n + 2) * p[n + 2])) / k);
        return p;
    }
    for (int n = 0; n + 2 < Polynomial::most; ++n)
        p.add(n + 2, (force[n] - d * (n + 1) * p[n + 1] - k * p[n]) / ((n + 1) * (n + 2)));
    return p;
}

}  // namespace vines
