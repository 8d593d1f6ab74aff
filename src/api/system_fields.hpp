// The numbers of a request that define a system and its start, and the core's parameters from them.
// Free of JSON, so that a sweep can repeat it at each point.
#pragma once

#include <optional>

#include "api/problem.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

/// A table of R: the field restitution, restitution_plus or restitution_minus.
struct RestitutionField {
    RestitutionTable table;
    bool in_si = false;  ///< its speeds are in m/s
};

/// Named as the request's fields; nullopt if not given.
struct SystemFields {
    std::optional<double> b, R, R_plus, R_minus;
    std::optional<double> epsilon, lambda, G, Omega;
    std::optional<double> m1, k1, f0, c1, damping_ratio, m2, mass_ratio, F, f;
    std::optional<double> gravity, inclination, friction, mu;
    std::optional<RestitutionField> restitution, restitution_plus, restitution_minus;
    std::optional<double> x0, x_dot0, x_velocity0, y0, y_dot0, y_velocity0;
    Damping damping = Damping::equation_of_motion;

    bool is_reduced() const { return epsilon || lambda || G || Omega; }
    bool is_in_si() const {
        return m1 || k1 || f0 || c1 || damping_ratio || m2 || mass_ratio || F || f;
    }
};

using SystemNumber = std::optional<double> SystemFields::*;
/// Null if a system has no number of this name.
SystemNumber system_number(const std::string& name);

/// Reads checked fields of a request; ignores others.
SystemFields system_fields(const Json& fields);

/// A system in SI; omitted values are those of Table 1, or follow from the rest in the case of F
/// and f.
SiParameters si_of(const SystemFields& fields);

struct ResolvedSystem {
    Parameters parameters;
    std::optional<SiParameters> si;  ///< if the fields are in SI
};
/// Omitted values are those of Table 1. Does not check the core's ranges.
ResolvedSystem resolve(const SystemFields& fields);

/// Velocities in m/s apply if the system is in SI.
State start_of(const SystemFields& fields, const ResolvedSystem& system);

}  // namespace vines::api
