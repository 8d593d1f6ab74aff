// Fast Fourier transform.
#pragma once

#include <complex>
#include <vector>

namespace vines {

using Signal = std::vector<std::complex<double>>;

/// Sums of c_k exp(sign 2 pi i k n/N) for n = 0 ... N - 1; N is a power of two, sign 1 or -1.
Signal fourier_sums(Signal c, int sign);

}  // namespace vines
