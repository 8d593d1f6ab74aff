// Model of a record: states, unknowns, residuals, priors.
//
// Between impacts the oscillator follows x'' + c x' + k x = f_s sin(Omega (tau - tau_m)) + f_c
// cos(Omega (tau - tau_m)), eq. (2), with tau = omega0 t for the given omega0 and tau_m the middle
// of the record; with exact given values k = 1 and c = 2 zeta. A channel of the forcing can add to
// the sines what it shows beyond them (measured_load.hpp). Each interval between two impacts has an
// initial state (x, x'); each impact has a time.
//
// The sensors show, for a sample at tau, with u = (tau - tau_m)/(length of the record):
//
//     displacement  X = x_gain x(tau - x_delay) + x_offset + x_drift u + noise
//     acceleration  A = x''(tau) + a_offset + a_drift u + pulses of the impacts + noise
//
// While the mass sticks to a wall both masses move as one: (1 + epsilon) x'' + c x' + k x equals
// the forcing. The phase ends where x'' = 0, with x and x' continuous.
//
// Residuals: all samples outside pulses; at each impact the continuity of x, and its time according
// to its pulse. Once the impacts are known, those of the mass follow (joint_fit_equations.cpp).
// Contacts that no sample shows, weak impacts and sticking phases, follow from a run of the system
// identified so far (hidden_contacts.hpp); then everything is fitted again. Priors for the given k
// and c, the delay and others are wide: the record is far more precise.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <memory>
#include <optional>

#include "core/motion/elementary.hpp"
#include "core/motion/parameters.hpp"

namespace vines {

/// Displacement x and its derivatives by tau.
struct OscillatorMotion {
    double x, x_dot, x_ddot;
};
inline OscillatorMotion operator+(const OscillatorMotion& a, const OscillatorMotion& b) {
    return {a.x + b.x, a.x_dot + b.x_dot, a.x_ddot + b.x_ddot};
}
inline OscillatorMotion operator-(const OscillatorMotion& a, const OscillatorMotion& b) {
    return {a.x - b.x, a.x_dot - b.x_dot, a.x_ddot - b.x_ddot};
}
inline OscillatorMotion operator*(double by, const OscillatorMotion& m) {
    return {by * m.x, by * m.x_dot, by * m.x_ddot};
}

/// Unknowns common to the whole record.
enum class Unknown {
    force_sin,  ///< f_s, m
    force_cos,  ///< f_c, m
    x_offset,   ///< m, in the middle of the record
    x_drift,    ///< m over the record
    a_offset,   ///< m per unit of tau squared
    a_drift,
    x_gain,   ///< scale of the displacement relative to the acceleration
    x_delay,  ///< delay of the displacement relative to the acceleration, in tau
    Omega,
    stiffness,  ///< k: squared ratio of the oscillator's frequency to the given omega0
    damping,    ///< c
    // Unknowns of the mass:
    b,        ///< m
    R_plus,   ///< wall at +b
    R_minus,  ///< wall at -b
    /// Delay of the impact times from pulses, in tau: those of the template are approximate.
    pulse_lag
};
inline constexpr std::size_t unknowns = 15;
/// The first unknowns: those on which a sample depends.
inline constexpr std::size_t sensed_unknowns = 11;

inline Unknown restitution_at(int side) { return side > 0 ? Unknown::R_plus : Unknown::R_minus; }

/// An entry for each unknown.
template <class T>
struct ForUnknowns : std::array<T, unknowns> {
    using std::array<T, unknowns>::operator[];
    T& operator[](Unknown u) { return (*this)[static_cast<std::size_t>(u)]; }
    T operator[](Unknown u) const { return (*this)[static_cast<std::size_t>(u)]; }
};
using UnknownValues = ForUnknowns<double>;  ///< values, or errors

/// Marks the unknowns that keep their values.
struct FixedUnknowns : ForUnknowns<bool> {
    /// Whether k and c both keep their values.
    bool oscillator() const { return (*this)[Unknown::stiffness] && (*this)[Unknown::damping]; }
};

class MeasuredLoad;

/// Smallest deviations from given values, relative to them, for which the record contradicts these.
inline constexpr double least_of_stiffness = 3e-4, least_of_damping = 0.01;

/// Given parameters of the forcing f sin(Omega tau + phase), and its measured load.
struct KnownForcing {
    std::optional<double> amplitude = {};  ///< f, m
    std::optional<double> phase = {};
    /// The forcing beyond its fundamental, from a channel (measured_load.hpp); null: a sine.
    std::shared_ptr<const MeasuredLoad> load = {};
};

/// Values for ideal sensors and the given oscillator, with a forcing in m.
inline UnknownValues given_unknowns(
    const Parameters& p, double force_sin = 0, double force_cos = 0) {
    UnknownValues v{};
    v[Unknown::force_sin] = force_sin;
    v[Unknown::force_cos] = force_cos;
    v[Unknown::x_gain] = 1;
    v[Unknown::Omega] = p.Omega;
    v[Unknown::stiffness] = 1;
    v[Unknown::damping] = 2 * p.zeta();
    v[Unknown::b] = p.b;
    v[Unknown::R_plus] = p.R_plus;
    v[Unknown::R_minus] = p.R_minus;
    return v;
}

/// Standard deviations of the priors; infinite without a prior. Masses and springs are known better
/// than this, dampings hardly; the displacement's scale to a tenth, its delay to part of a cycle.
inline UnknownValues priors(const Parameters& p) {
    UnknownValues sigma;
    sigma.fill(infinity);
    sigma[Unknown::x_gain] = 0.1;
    sigma[Unknown::x_delay] = 0.1;
    sigma[Unknown::Omega] = 0.02 * p.Omega;
    sigma[Unknown::stiffness] = 0.02;
    sigma[Unknown::damping] = std::max(0.5 * 2 * p.zeta(), 1e-3);
    return sigma;
}

/// Amplitude f of the forcing in eq. (2), m.
inline double forcing_of(const Parameters& p) {
    return p.G * p.epsilon * elementary::hypot(1.0, p.lambda * p.epsilon * p.Omega);
}

/// G of a forcing f_s sin(Omega tau) + f_c cos(Omega tau), eq. (3), m.
inline double G_of(const Parameters& p, double force_sin, double force_cos) {
    return elementary::hypot(force_sin, force_cos) / p.epsilon /
           elementary::hypot(1.0, p.lambda * p.epsilon * p.Omega);
}

}  // namespace vines
