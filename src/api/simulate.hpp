// From a request to its answer.
#pragma once

#include <functional>

#include "api/answer_size.hpp"

namespace vines::api {

/// What may end a run from outside: asked every few events; once it says true, the answer is what
/// was found until then, and status has this reason and message.
struct Stop {
    std::function<bool()> asked = {};
    std::string reason = "deadline";
    std::string message = "ended by the server's time limit for one request, before tau_end";
    /// Asked while the run is analysed: once true, what takes long is cut short.
    std::function<bool()> analysis_late = {};
    /// Asked while the answer is made up: once true, the parts that are left are null.
    std::function<bool()> late = {};
};

/// An answer of no more than about so many bytes of JSON: see fit_answer().
Json simulate_answer(SimulateRequest request, const Stop& stop, std::size_t most_bytes = any_size);

/// The manifold, and the b that is recommended beside it: none once stop.asked() is true.
Json manifold_answer(const ManifoldRequest& request, const Stop& stop = {});

/// The version of this build.
std::string version();

}  // namespace vines::api
