// The model of a record: states, unknowns, residuals, priors.
//
// The oscillator moves by x'' + c x' + k x = f_s sin(Omega (tau - tau_m)) + f_c cos(Omega (tau -
// tau_m)) between impacts, eq. (2), with tau = omega0 t of the omega0 that was given: so k = 1 and
// c = 2 zeta but for what was given wrong. tau_m is the record's middle. Each interval between two
// impacts has a state (x, x') at its start; each impact has a moment.
//
// The sensors show, of a sample at tau, with u = (tau - tau_m)/(length of the record):
//
//     displacement  X = x_gain x(tau - x_delay) + x_offset + x_drift u + noise
//     acceleration  A = x''(tau) + a_offset + a_drift u + pulses of the impacts + noise
//
// An interval in which the mass sticks to a wall has the law of both masses as one, (1 + epsilon)
// x''
// + c x' + k x; it ends where nothing accelerates the two, with x and x' continuous.
//
// Residuals: those of all samples that no pulse spoils; at each impact that x is continuous, and
// its moment by its pulse. Once the impacts are known, those of the mass (mass_rows.hpp): between
// impacts it flies with one velocity from wall to wall, eq. (43), at each impact x' + epsilon y' is
// kept (36), and R of each wall is one, eq. (4). What no sample shows, impacts too weak and stuck
// phases, follows from a run of what is identified so far (hidden_contacts.hpp); then all is fitted
// anew.
//
// Priors: what was given of k and c is known to stiffness_prior and damping_prior, the clocks of
// the two channels agree to delay_prior, and so on. They are wide: what a record says is far
// sharper.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "core/motion/parameters.hpp"

namespace vines {

/// What holds for the whole record.
enum class Unknown {
    force_sin,  ///< f_s, m
    force_cos,  ///< f_c, m
    x_offset,   ///< m, in the middle of the record
    x_drift,    ///< m over the record
    a_offset,   ///< m per unit of tau squared
    a_drift,
    x_gain,   ///< of the displacement against the acceleration
    x_delay,  ///< of the displacement behind the acceleration, in tau
    Omega,
    stiffness,  ///< k: of the oscillator's own frequency, squared, over the given one's
    damping,    ///< c
    // Of the mass:
    b,        ///< m
    R_plus,   ///< of the wall at +b
    R_minus,  ///< at -b
    /// By how much the moments that the pulses tell are late, in tau: a template was laid over
    /// impacts that were only about known.
    pulse_lag
};
inline constexpr std::size_t unknowns = 15;
/// The first ones, those that a sample depends on.
inline constexpr std::size_t sensed_unknowns = 11;

inline Unknown restitution_at(int side) { return side > 0 ? Unknown::R_plus : Unknown::R_minus; }

/// A value of each of them, or an error.
class UnknownValues : public std::array<double, unknowns> {
public:
    using std::array<double, unknowns>::operator[];
    double& operator[](Unknown u) { return (*this)[static_cast<std::size_t>(u)]; }
    double operator[](Unknown u) const { return (*this)[static_cast<std::size_t>(u)]; }
};

/// Which of them stay as they are.
class FixedUnknowns : public std::array<bool, unknowns> {
public:
    using std::array<bool, unknowns>::operator[];
    bool& operator[](Unknown u) { return (*this)[static_cast<std::size_t>(u)]; }
    bool operator[](Unknown u) const { return (*this)[static_cast<std::size_t>(u)]; }
};

/// What is known of the forcing f sin(Omega tau + phase), if anything.
struct KnownForcing {
    std::optional<double> amplitude = {};  ///< f, m
    std::optional<double> phase = {};
};

/// Of sensors without a fault, and the oscillator as it is given.
UnknownValues given_unknowns(const Parameters& parameters);
/// The amplitude f of eq. (2)'s forcing, m.
double forcing_of(const Parameters& parameters);
/// G of a forcing f_s sin(Omega tau) + f_c cos(Omega tau), eq. (3).
double G_of(const Parameters& parameters, double force_sin, double force_cos);
/// Standard deviations of the priors; infinite where there is none.
UnknownValues priors(const Parameters& parameters);

}  // namespace vines
