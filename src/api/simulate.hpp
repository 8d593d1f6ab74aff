// Requests and answers of /v1/simulate and /v1/manifold.
#pragma once

#include "api/columns.hpp"
#include "api/describe.hpp"
#include "api/provenance.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

struct SimulateRequest {
    System system;
    AnalysisRequest wanted;  ///< the run and its results; parameters as in `system`
};

/// Problem 422 naming every invalid field.
SimulateRequest read_simulate_request(const Json& object);

/// The estimators of the field exponents, with a history of max_points.
ExponentOptions read_estimators(const MergedFields& fields);

struct ManifoldRequest {
    System system;
    double V_max;  ///< 0: not given
    std::size_t points;
};

/// Problem 422 naming every invalid field, also if R differs between the walls.
ManifoldRequest read_manifold_request(const Json& object);

/// Ends a run from outside. `requested` is polled every few events; once it returns true, the
/// answer holds the results so far, with this reason and message in its status.
struct Stop {
    std::function<bool()> requested = {};
    std::string reason = "deadline";
    std::string message =
        "ended before tau_end by the server's time limit for one request, or because the server "
        "stops";
    /// Polled during the analysis of the run; once true, long searches are cut short.
    std::function<bool()> analysis_late = {};
    /// Polled while the answer is assembled; once true, the remaining parts are null.
    std::function<bool()> late = {};
};

/// A run and the range of its listed impacts.
struct ListedRun {
    AnalysisRequest wanted;
    ImpactRange listed;
    ImpactScales scales;
};

/// An answer. Impact lists too long for memory are placeholders, see list_generator().
struct Answer {
    Json json;
    std::optional<ListedRun> run = {};
    long impacts = 0;        ///< of the run, listed or not
    bool is_fitted = false;  ///< cut to `most_bytes`
    std::optional<Provenance> provenance = {};
};

// The listed impacts kept in memory. Impacts, their columns in both units and the text take 45 MB.
inline constexpr std::size_t most_kept_impacts = 1 << 15;
// Memory in bytes for a column of numbers and one of sides of the longest possible list.
inline constexpr std::size_t most_listed_bytes = 24 << 20;

/// An answer of at most about `most_bytes` of JSON, for which max_points, down to 256, and the
/// count of listed impacts are lowered. More than `most_kept` listed impacts become streamed lists.
/// begins(bytes) is called before the run, with about the memory that its lists take.
Answer simulate_in_parts(
    SimulateRequest request, const Stop& stop, std::size_t most_bytes = any_size,
    std::size_t most_kept = everything, const std::function<void(std::size_t)>& begins = {});

/// write_sealed(). Streamed lists are generated meanwhile by runs at `control`, as many per run as
/// fit into `list_bytes`. Throws Cancelled if `control` stops a run.
std::string write_answer(
    Answer answer, RunControl& control, const JsonText::Take& take,
    std::size_t list_bytes = most_listed_bytes);

// Long lists of impacts (streamed_impacts.cpp).

/// The columns of describe_impacts() and their SI counterparts as placeholders.
Json streamed_impacts(const std::optional<SiParameters>& si);

/// A function for JsonText that generates the placeholder lists of `answer`, in their order. Each
/// repetition of the run fills as many columns as fit into `most_bytes`, at least one, between
/// control.begin() and control.end(). The function throws Cancelled if `control` stops a run.
JsonText::ListOf list_generator(
    const ListedRun& run, const Json& answer, RunControl& control, std::size_t most_bytes);

/// The manifold, and the recommended b: null once stop.requested() returns true.
Json manifold_answer(const ManifoldRequest& request, const Stop& stop = {});

}  // namespace vines::api
