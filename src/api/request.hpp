// Reads the JSON of a request into structs.
#pragma once

#include "api/system.hpp"
#include "core/analysis/analysis.hpp"

namespace vines::api {

struct SimulateRequest {
    System system;
    AnalysisRequest wanted;         ///< the run and its results; parameters as in `system`
    std::set<std::string> include;  ///< parts of the answer

    bool includes(const char* part) const { return include.contains(part); }
};

/// Problem 422 naming every invalid field.
SimulateRequest read_simulate_request(const Json& object);

/// The estimators of the field exponents, with a history of max_points.
ExponentOptions read_estimators(const MergedFields& fields);

/// A system with its initial state: a point of a sweep.
struct StartedSystem {
    System system;
    State start;
    long max_impacts;
    std::vector<FieldError> errors;  ///< values that form no valid system; empty: valid
};
/// Reads sweep_base_fields(). Problem 422 for fields that are invalid by themselves, that exclude
/// each other or that are missing.
StartedSystem read_started_system(const Json& object);

struct ManifoldRequest {
    System system;
    double V_max;  ///< 0: not given
    std::size_t points;
};

/// Problem 422 naming every invalid field, also if R differs between the walls.
ManifoldRequest read_manifold_request(const Json& object);

}  // namespace vines::api
