// From a request to its answer.
#pragma once

#include <functional>

#include "api/request.hpp"

namespace vines::api {

/// Runs it. `stop` is asked every few events; once it says true, the answer is what was found until then, with
/// status.reason "deadline".
Json simulate_answer(const SimulateRequest& request, const std::function<bool()>& stop);

Json manifold_answer(const ManifoldRequest& request);

/// The version of this build.
std::string version();

}  // namespace vines::api
