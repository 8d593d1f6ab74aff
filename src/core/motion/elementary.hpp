// Elementary functions that give the same bits on every machine. Those of the C library do not: it
// selects variants by processor, and they differ in the last bit. These use only + - * / and the
// square root, which IEEE 754 defines to the last bit, and are compiled without fused operations.
//
// Errors are in ulps of the result, including 0.5 ulp of final rounding. Special cases (0,
// infinities, NaN, the sign of a zero) are as in C unless stated otherwise.
#pragma once

#include <cmath>
#include <complex>
#include <cstdint>
#include <limits>
#include <numbers>

namespace vines {

/// Short names for NaN and infinity.
inline constexpr double nan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace vines

namespace vines::elementary {

/// Natural logarithm, error below 0.51 ulp; NaN below 0.
double log(double x);

/// Error below 0.51 ulp; below 0.76 ulp where the result is subnormal.
double exp(double x);

/// x^y for x >= 0, otherwise NaN; error below 0.51 + |y|/2^15 ulp.
double pow(double x, double y);

/// x in radians. Error below 0.51 ulp for |x| up to 2^31, plus 1e-30 up to 2^47. Beyond that x is
/// reduced modulo the double next to 2 pi.
double sin(double x);
double cos(double x);

/// Angle of the point (x, y) in [-pi, pi]; error below 0.51 ulp unless subnormal.
double atan2(double y, double x);
double atan(double x);

/// sqrt(x^2 + y^2); error below 0.51 ulp unless subnormal.
double hypot(double x, double y);

/// exp(i angle).
inline std::complex<double> phasor(double angle) { return {cos(angle), sin(angle)}; }
/// Modulus of a complex number; std::abs calls the C library.
inline double modulus(const std::complex<double>& z) { return hypot(z.real(), z.imag()); }

}  // namespace vines::elementary

namespace vines {

// Random numbers that are the same everywhere: standard distributions differ between libraries.
// `engine` returns 64 random bits (std::mt19937_64, RandomSequence).

/// Random bits (splitmix64), each a function of the seed and its number.
class RandomSequence {
public:
    explicit RandomSequence(std::uint64_t seed) : state_(seed) {}
    std::uint64_t operator()() {
        std::uint64_t z = state_ += step;
        z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
        z = (z ^ z >> 27) * 0x94d049bb133111eb;
        return z ^ z >> 31;
    }
    /// A sequence of its own for each index.
    RandomSequence part(std::uint64_t index) const {
        return RandomSequence(RandomSequence(state_ + index * step)());
    }

private:
    static constexpr std::uint64_t step = 0x9e3779b97f4a7c15;
    std::uint64_t state_;
};

/// Uniform in [from, to).
template <class Engine>
double uniform(Engine& engine, double from, double to) {
    return from + (to - from) * static_cast<double>(engine() >> 11) * 0x1p-53;
}

/// Standard normal (Box-Muller).
template <class Engine>
double standard_normal(Engine& engine) {
    const double u = uniform(engine, 1e-300, 1), v = uniform(engine, 0, 1);
    return std::sqrt(-2 * elementary::log(u)) * elementary::cos(2 * std::numbers::pi * v);
}

}  // namespace vines
