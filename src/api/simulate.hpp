// From a request to its answer.
#pragma once

#include <functional>

#include "api/answer_size.hpp"
#include "api/impact_columns.hpp"
#include "api/provenance.hpp"

namespace vines::api {

/// What may end a run from outside: asked every few events; once it says true, the answer is what
/// was found until then, and status has this reason and message.
struct Stop {
    std::function<bool()> asked = {};
    std::string reason = "deadline";
    std::string message =
        "ended before tau_end by the server's time limit for one request, or because it stops";
    /// Asked while the run is analysed: once true, what takes long is cut short.
    std::function<bool()> analysis_late = {};
    /// Asked while the answer is made up: once true, the parts that are left are null.
    std::function<bool()> late = {};
};

/// An answer. Its lists of impacts, where they are too long to be kept, are to come of `run`.
struct Answer {
    Json json;
    std::optional<ListedRun> run = {};
    long impacts = 0;        ///< of the run, told or not
    bool is_fitted = false;  ///< it would have had more than `most_bytes`
    std::optional<Provenance> provenance = {};
};

// So many impacts, their columns in both units and the text of these take 45 MB.
inline constexpr std::size_t most_kept_impacts = 1 << 15;
// A column of numbers, and one of sides, of the longest list that can be asked for.
inline constexpr std::size_t most_listed_bytes = 24 << 20;

/// Of no more than about `most_bytes` of JSON: see fit_answer(). More listed impacts than
/// `most_kept` are to come.
Answer simulate_in_parts(
    SimulateRequest request, const Stop& stop, std::size_t most_bytes = any_size,
    std::size_t most_kept = most_kept_impacts);

/// Writes its text, a line, in pieces, sealed where there is a provenance. Lists to come are made
/// while it is written, as many at a time as fit into `list_bytes`, by runs at `pace`. Throws
/// BrokenOff where that stops one.
void write_answer(
    Answer answer, Pace& pace, const JsonText::Take& take,
    std::size_t list_bytes = most_listed_bytes);

/// The same with all lists.
Json simulate_answer(SimulateRequest request, const Stop& stop, std::size_t most_bytes = any_size);

/// The manifold, and the b that is recommended beside it: none once stop.asked() is true.
Json manifold_answer(const ManifoldRequest& request, const Stop& stop = {});

}  // namespace vines::api
