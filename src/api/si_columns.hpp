// Adds SI counterparts to an answer: s, m/s, m/s^2, N s or J next to each quantity in units of tau.
#pragma once

#include "api/problem.hpp"
#include "api/quantity.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

/// The SI counterpart of a quantity over its value.
double si_factor(const Quantity& quantity, const SiParameters& si);

/// Adds the counterparts to an object and to everything in it: time_s for tau, x_velocity (m/s) for
/// x_dot, impulse_N_s for impulse. Nulls stay null; a counterpart that the object has stays.
void add_si(Json& part, const SiParameters& si);

/// Adds those of the part `energy`, whose energies are per m1 omega0^2: input_J for input.
void add_joules(Json& energy, const SiParameters& si);

}  // namespace vines::api
