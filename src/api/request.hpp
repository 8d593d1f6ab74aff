// From the JSON of a request to the structs that it stands for.
#pragma once

#include <optional>
#include <set>

#include "api/fields.hpp"
#include "core/lyapunov.hpp"

namespace vines::api {

/// The parameters of a request. `si`: the same in SI, where the request or its preset is in SI.
struct System {
    Parameters parameters;
    std::optional<SiParameters> si;
};

struct Interval {
    double from, to;  ///< tau
};

struct SimulateRequest {
    System system;
    State start;
    double tau_end;
    Interval window;
    std::vector<Interval> windows;
    double samples_per_cycle;
    std::size_t max_points;
    long max_impacts;
    std::size_t listed_impacts;  ///< the last so many impacts, sticks and touches are listed: all, unless the answer's size is limited
    std::set<std::string> include;
    ExponentOptions estimators;

    bool includes(const char* part) const { return include.contains(part); }
};

/// Problem 422 with every field at fault.
SimulateRequest read_simulate_request(const Json& object);

/// A system with its initial state: what the points of a sweep are.
struct StartedSystem {
    System system;
    State start;
    long max_impacts;
};
/// Of sweep_base_fields(). Problem 422 with every field at fault.
StartedSystem read_started_system(const Json& object);

/// Throws a Problem 422 that lists the errors.
[[noreturn]] void refuse(std::vector<FieldError> errors);

/// The fields of a table over those of the request's preset, each checked by itself. A field that is given replaces its own value
/// of the preset alone. Problem 422 where one is at fault.
Json checked(const std::vector<Field>& fields, const Json& given);
/// The system of fields that are checked. Problem 422 where they make none together, at those that are `given`.
System read_checked_system(const std::vector<Field>& fields, const Json& checked, const Json& given);

struct ManifoldRequest {
    System system;
    double V_max;  ///< 0: not given
    std::size_t points;
};

/// Problem 422 with every field at fault; also for walls with different restitution coefficients.
ManifoldRequest read_manifold_request(const Json& object);

}  // namespace vines::api
