// Periodic orbits of the forced system: found by Newton's method on the return of the state after
// whole forcing cycles.
//
// The derivative of the return map is the transfer matrix over the period (the monodromy matrix),
// the same matrices as the exponents are made of. Its eigenvalues are the Floquet multipliers: the
// orbit attracts if all lie inside the unit circle.
#pragma once

#include <array>
#include <complex>
#include <functional>
#include <optional>

#include "core/motion/elementary.hpp"
#include "core/stability/lyapunov.hpp"

namespace vines {

/// What the components of a state are measured by: about the largest that each one takes.
State scale_of(const Parameters& parameters, std::span<const State> states);
/// The largest difference of a component, in units of its scale.
double distance(const State& a, const State& b, const State& scale);

struct PeriodicOrbit {
    int cycles;      ///< period in forcing cycles, the smallest
    double tau;      ///< a moment of it, inside a flight, 0 <= tau < 2 pi/Omega
    State state;     ///< there
    double closure;  ///< distance of the state and its return
    /// Impacts per period, those of a chatter that ends in a stick counted as one.
    long contacts;
    long impacts, sticks;  ///< all of them
    bool symmetric;        ///< x(tau + half the period) = -x(tau), and y alike
    std::array<std::complex<double>, 4> multipliers;  ///< by descending modulus

    Eigen::Matrix4d monodromy;  ///< derivative of the return map there

    bool stable() const { return elementary::modulus(multipliers[0]) < 1; }
    /// ln|multiplier| / period: the exponents of every motion that the orbit attracts; -infinity
    /// for a multiplier of 0.
    Exponents exponents(const Parameters& parameters) const;
};

/// The state at tau + duration of a motion that starts at tau, or none where that takes too many
/// impacts or was stopped.
std::optional<State> follow(
    const Parameters& parameters, const State& start, double tau, double duration,
    const std::function<bool()>& stop, std::span<Observer* const> observers = {});

/// The orbit of a period of so many cycles (or of a divisor of it) next to the state at a whole
/// cycle, if Newton's method finds one within `reach` of it before it is stopped.
std::optional<PeriodicOrbit> find_orbit(
    const Parameters& parameters, const State& at_whole_cycle, int cycles, const State& scale,
    double reach, const std::function<bool()>& stop);

/// So close, in units of the scale, a motion is on an orbit that attracts it, and stays: from order
/// one a chance return would need 1e16 cycles or more.
inline constexpr double on_the_orbit = 1e-8;

/// Whether a stable orbit attracts the motion from a state at a whole cycle. The proof is to follow
/// it: it comes so close that no chance explains it, or, where the orbit contracts too slowly for
/// that, it moves as the orbit's own linear map says, far more precisely than that contracts. A
/// motion that only passes by does neither.
bool attracts(
    const Parameters& parameters, const PeriodicOrbit& orbit, const State& at_whole_cycle,
    const State& scale, const std::function<bool()>& stop);

/// The orbit's states at the next whole cycles 1, ..., orbit.cycles after its moment `tau`.
std::vector<State> whole_cycle_states(const Parameters& parameters, const PeriodicOrbit& orbit);

}  // namespace vines
