// From the JSON of a simulate request to its answer.
#pragma once

#include <functional>
#include <optional>

#include "api/fields.hpp"
#include "core/lyapunov.hpp"
#include "core/parameters.hpp"

namespace vines::api {

struct SimulateRequest {
    Parameters parameters;
    std::optional<SiParameters> si;  ///< where the request gave SI fields: the reduced ones above follow from these
    State start;
    double tau_end;
    double window_start, window_end;
    double samples_per_cycle;
    std::size_t max_points;
    long max_impacts;
    bool series, impacts, exponents;
    ExponentOptions estimators;
};

/// Problem 422 with every field at fault.
SimulateRequest read_simulate_request(const Json& object);

/// Runs it. `stop` is asked every few events; once it says true, the answer is what was found until then, with
/// status.reason "deadline".
Json simulate_answer(const SimulateRequest& request, const std::function<bool()>& stop);

/// The version of this build.
std::string version();

}  // namespace vines::api
