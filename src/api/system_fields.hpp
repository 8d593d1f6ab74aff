// The fields of a request that define a system and its start, and the core's parameters from them,
// for a request and for each point of a sweep.
#pragma once

#include <memory>
#include <mutex>
#include <optional>

#include "api/problem.hpp"
#include "core/motion/load.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

/// A table of R: the field restitution, restitution_plus or restitution_minus.
struct RestitutionField {
    RestitutionTable table;
    bool in_si = false;  ///< its speeds are in m/s
};

/// The load of the field `forcing`, whose sub-fields are checked by themselves. Problem 422 for one
/// that is invalid.
std::shared_ptr<const Load> read_load(const Json& forcing, const SiParameters& si);

/// The field forcing, whose load depends on the oscillator. Keeps the last load: the points of most
/// sweeps share it.
class ForcingField {
public:
    explicit ForcingField(Json given) : given_(std::move(given)) {}
    /// Problem 422 for an invalid load.
    std::shared_ptr<const Load> load(const SiParameters& si) const;

private:
    const Json given_;
    mutable std::mutex mutex_;
    mutable std::shared_ptr<const Load> last_;
    mutable double omega0_ = 0, k1_ = 0;  // of last_
};

/// Named as the request's fields; nullopt if not given.
struct SystemFields {
    std::optional<double> b, R, R_plus, R_minus;
    std::optional<double> epsilon, lambda, G, Omega;
    std::optional<double> m1, k1, f0, c1, damping_ratio, m2, mass_ratio, F, f, acceleration;
    std::optional<double> gravity, inclination, friction, mu;
    std::shared_ptr<const ForcingField> forcing;
    std::optional<RestitutionField> restitution, restitution_plus, restitution_minus;
    std::optional<double> x0, x_dot0, x_velocity0, y0, y_dot0, y_velocity0;
    Damping damping = Damping::equation_of_motion;

    /// True if the base moves harmonically: its amplitude is not given as zero.
    bool is_forced() const { return !forcing && F != 0.0 && acceleration != 0.0; }
    bool is_reduced() const { return epsilon || lambda || G || Omega; }
    bool is_in_si() const {
        return m1 || k1 || f0 || c1 || damping_ratio || m2 || mass_ratio || F || f || acceleration;
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
/// Omitted values are those of Table 1. Does not check the core's ranges. Problem 422 for an
/// invalid load; a load needs a system in SI.
ResolvedSystem resolve(const SystemFields& fields);

/// Velocities in m/s apply if the system is in SI.
State start_of(const SystemFields& fields, const ResolvedSystem& system);

}  // namespace vines::api
