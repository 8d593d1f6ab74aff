// Whether the motion really follows an orbit of periodic_impacts.hpp: the equations also have
// solutions that pass through a wall. Each flight is searched for contacts from its own start, so
// that the orbit's instability does not matter.
#pragma once

#include "core/continuation/periodic_impacts.hpp"
#include "core/stability/orbit.hpp"

namespace vines {

/// Quantities of an orbit.
struct OrbitMeasures {
    State at_whole_cycle;                 ///< with the phase of tau = 0
    double x_max, x_rms;                  ///< m
    std::optional<double> share_impacts;  ///< fraction of the dissipation that is due to impacts
};

/// First difference between the sequence and the motion.
struct SequenceFault {
    enum class Kind {
        contact,  ///< a contact at the time `s` of flight k, with the wall `side`
        missing,  ///< the impact at the end of flight k does not take place
        stick     ///< the ball sticks to the wall instead of flight k
    };
    Kind kind;
    std::size_t flight = 0;
    double s = 0;
    int side = 0;
};

struct OrbitCheck {
    std::optional<SequenceFault> fault;  ///< none: the orbit exists
    OrbitMeasures measures{};
};

/// `approach`: OrbitValues::approach.
OrbitCheck check_orbit(
    const OrbitEquations& equations, const Unknowns& z, const std::vector<double>& approach);

/// The sequence and the unknowns of an orbit that has impacts and does not stick; otherwise empty.
/// The parameters of `family`, at the orbit, are `values`.
struct OrbitStart {
    ImpactSequence sequence;
    Unknowns z;
};
std::optional<OrbitStart> orbit_start(
    const Parameters& p, const PeriodicOrbit& orbit, double length, const ParameterFamily& family,
    const std::vector<double>& values);

}  // namespace vines
