// The numbers of a request that make a system and its start, and the arithmetic from them to the
// core's parameters: without JSON, so that a sweep does it anew at each point.
#pragma once

#include <optional>
#include <string>

#include "api/problem.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

/// By the names of the request's fields; empty where a field is not given.
struct SystemFields {
    std::optional<double> b, R, R_plus, R_minus;
    std::optional<double> epsilon, lambda, G, Omega;
    std::optional<double> m1, k1, f0, c1, damping_ratio, m2, mass_ratio, F, f;
    std::optional<double> x0, x_dot0, x_velocity0, y0, y_dot0, y_velocity0;
    Damping damping = Damping::equation_of_motion;

    bool is_reduced() const { return epsilon || lambda || G || Omega; }
    bool is_in_si() const {
        return m1 || k1 || f0 || c1 || damping_ratio || m2 || mass_ratio || F || f;
    }
};

using SystemNumber = std::optional<double> SystemFields::*;
/// Null where no number of a system has this name.
SystemNumber system_number(const std::string& name);

/// Of the fields of a request, each checked by itself; others are passed over.
SystemFields system_fields(const Json& fields);

/// A system in SI, of which what is left out is Table 1's; F and f then follow from the rest.
SiParameters si_of(const SystemFields& fields);

struct ResolvedSystem {
    Parameters parameters;
    std::optional<SiParameters> si;  ///< where the fields are in SI
};
/// What is left out is Table 1's. The core's ranges are not checked here.
ResolvedSystem resolve(const SystemFields& fields);

/// Velocities in m/s count where the system is in SI.
State start_of(const SystemFields& fields, const ResolvedSystem& system);

}  // namespace vines::api
