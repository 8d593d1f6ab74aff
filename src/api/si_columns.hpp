// Adds SI counterparts to an answer: s, m/s, m/s^2, N s or J next to each quantity in units of tau.
#pragma once

#include <span>

#include "api/problem.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

/// A quantity in units of tau and its SI counterpart = value * omega0^power, also times m1 if
/// per_m1.
struct SiCounterpart {
    const char *name, *si_name;
    int power;
    bool per_m1 = false;
};

/// The quantities of any part; the additional ones of the part `energy`.
std::span<const SiCounterpart> si_counterparts();
std::span<const SiCounterpart> energy_counterparts();

/// Adds the counterparts to an object and to everything in it: time_s for tau, x_velocity (m/s) for
/// x_dot, x_acceleration (m/s^2) for x_ddot, impulse_N_s for impulse. Nulls stay null.
void add_si(Json& part, const SiParameters& si);

/// Adds those of the part `energy`, whose energies are per m1 omega0^2: input_J for input.
void add_joules(Json& energy, const SiParameters& si);

}  // namespace vines::api
