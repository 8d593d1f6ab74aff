// The system that a measurement shows, as one that can be run from a moment of the measurement.
#pragma once

#include <span>

#include "core/measurement/interval_motion.hpp"
#include "core/measurement/release.hpp"
#include "core/motion/record.hpp"

namespace vines {

class IdentifiedSystem {
public:
    /// `parameters`: with b, R of each wall and Omega as they are identified. Of `values` the
    /// forcing, whose phase is that at `tau_zero`, and the oscillator.
    IdentifiedSystem(const Parameters& parameters, const UnknownValues& values, double tau_zero);

    /// A run from a moment on; velocities and tau of the measurement. The observers are told of it
    /// in the time of its own oscillator, in which it is `faster()`, from start_of(tau) on.
    Outcome run(
        double tau, const State& state, Limits limits, std::span<Observer* const> observers) const;
    double start_of(double tau) const;
    double faster() const { return faster_; }

    /// The oscillator alone, from a state on.
    OscillatorMotion free_motion(const Release& from, double tau) const;
    /// An impact of a run from `tau` on as the measurement would show it.
    Impact measured(Impact impact, double tau) const;
    double moment(double own_tau, double tau) const {
        return (own_tau - start_of(tau)) / faster_ + tau;
    }
    const Parameters& own() const { return own_; }

private:
    const UnknownValues values_;
    const OscillatorFlows flows_;
    Parameters own_;
    double faster_, phase_, tau_zero_;
};

}  // namespace vines
