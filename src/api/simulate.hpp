// From a request to its answer.
#pragma once

#include <functional>

#include "api/request.hpp"

namespace vines::api {

/// What may end a run from outside: asked every few events; once it says true, the answer is what was found until then, and
/// status has this reason and message.
struct Stop {
    std::function<bool()> asked = {};
    std::string reason = "deadline";
    std::string message = "ended by the server's time limit for one request, before tau_end";
};

Json simulate_answer(const SimulateRequest& request, const Stop& stop);

Json manifold_answer(const ManifoldRequest& request);

/// The version of this build.
std::string version();

}  // namespace vines::api
