// Impacts as an acceleration shows them, however long each one rings: one event for each cluster
// of spikes.
#pragma once

#include <vector>

#include "core/measurement/pulse_signal.hpp"

namespace vines {

/// A cluster of spikes.
struct PulseEvent {
    double tau;     ///< of the middle of its highest spike
    double height;  ///< of that, with its sign
};

struct PulseEvents {
    std::vector<PulseEvent> events;  ///< in order
    /// How far a typical one stands out from the noise, before and after its highest spike, in tau.
    double before, after;
};

/// What stands out by `sigmas` times the noise and is no part of a higher event beside it: how
/// events fade is read from the highest ones. `step`: between samples, typically.
PulseEvents pulse_events(
    const std::vector<double>& tau, double step, const PulseSignal& signal,
    const std::vector<char>& bad, double sigmas, IdentificationProgress& progress);

}  // namespace vines
