// Fast Fourier transform.
#pragma once

#include <complex>
#include <numbers>
#include <utility>
#include <vector>

#include "core/motion/elementary.hpp"

namespace vines {

using Signal = std::vector<std::complex<double>>;

/// Sums of c_k exp(sign 2 pi i k n/N) for n = 0 ... N - 1; N is a power of two, sign 1 or -1.
inline Signal fourier_sums(Signal c, int sign) {
    const std::size_t N = c.size();
    for (std::size_t i = 1, j = 0; i < N; ++i) {
        std::size_t bit = N >> 1;
        for (; j & bit; bit >>= 1) j ^= bit;
        j ^= bit;
        if (i < j) std::swap(c[i], c[j]);
    }
    Signal roots(N / 2);
    for (std::size_t k = 0; k < roots.size(); ++k)
        roots[k] = elementary::phasor(
            sign * 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(N));
    for (std::size_t half = 1; half < N; half *= 2)
        for (std::size_t from = 0; from < N; from += 2 * half)
            for (std::size_t k = 0; k < half; ++k) {
                const auto odd = c[from + half + k] * roots[k * (N / (2 * half))];
                c[from + half + k] = c[from + k] - odd;
                c[from + k] += odd;
            }
    return c;
}

}  // namespace vines
