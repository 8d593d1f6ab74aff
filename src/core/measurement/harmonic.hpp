// The dominant harmonic of a channel that shows the excitation: base acceleration or force.
#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace vines {

/// The function offset + sin sin(omega t) + cos cos(omega t), in the given unit of time.
struct Harmonic {
    double omega;  ///< per unit of time
    double sin, cos;
};

/// Fits one harmonic. The frequency comes from the mean crossings first, then from the phase drift
/// between shorter pieces. Empty if the harmonic explains less than three quarters of the signal,
/// or with fewer than five cycles. look() is called before each pass through the samples; an
/// exception it throws passes through.
std::optional<Harmonic> harmonic_of(
    const std::vector<double>& time, const std::vector<double>& values,
    const std::function<void()>& look = [] {});

}  // namespace vines
