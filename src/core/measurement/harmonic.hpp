// The one harmonic of a channel that shows how the oscillator is driven: its base, or a force.
#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace vines {

/// offset + sin sin(omega t) + cos cos(omega t), t as it is given.
struct Harmonic {
    double omega;  ///< per unit of time
    double sin, cos;
};

/// Its frequency from how often the signal crosses its mean, then from how the phase of shorter
/// pieces moves. None where one harmonic explains less than three quarters of the signal, or there
/// are fewer than five cycles. look(): called before
/// each pass through the samples; what it throws ends this.
std::optional<Harmonic> harmonic_of(
    const std::vector<double>& time, const std::vector<double>& values,
    const std::function<void()>& look = {});

}  // namespace vines
