// From the JSON of a request to the structs that it stands for.
#pragma once

#include "api/system.hpp"
#include "core/analysis/analysis.hpp"

namespace vines::api {

struct SimulateRequest {
    System system;
    Wanted wanted;                  ///< of the run: its parameters are the system's
    std::set<std::string> include;  ///< parts of the answer

    bool includes(const char* part) const { return include.contains(part); }
};

/// Problem 422 with every field at fault.
SimulateRequest read_simulate_request(const Json& object);

/// Those that the field exponents names, with a history of max_points.
ExponentOptions read_estimators(const Layered& fields);

/// A system with its initial state: what the points of a sweep are.
struct StartedSystem {
    System system;
    State start;
    long max_impacts;
};
/// Of sweep_base_fields(). Problem 422 with every field at fault.
StartedSystem read_started_system(const Json& object);

struct ManifoldRequest {
    System system;
    double V_max;  ///< 0: not given
    std::size_t points;
};

/// Problem 422 with every field at fault; also for walls with different restitution coefficients.
ManifoldRequest read_manifold_request(const Json& object);

}  // namespace vines::api
