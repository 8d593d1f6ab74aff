// The answer in the units of a question in SI: beside each quantity in units of tau its twin in s,
// m/s, m/s^2, N s or J.
#pragma once

#include <span>

#include "api/problem.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

/// A quantity in units of tau and its twin: value * omega0^power, and m1 beside it for what is per
/// m1.
struct Twin {
    const char *name, *si_name;
    int power;
    bool per_m1 = false;
};

/// Those of any part, and those of the part `energy` besides.
std::span<const Twin> twins();
std::span<const Twin> joule_twins();

/// Adds the twins to an object and to all that it holds: time_s beside tau, x_velocity (m/s) beside
/// x_dot, x_acceleration (m/s^2) beside x_ddot, impulse_N_s beside impulse. A column has a column
/// beside it, null where it is null.
void add_si(Json& part, const SiParameters& si);

/// The same for the part `energy`, whose energies are per m1 omega0^2: input_J beside input.
void add_joules(Json& energy, const SiParameters& si);

}  // namespace vines::api
