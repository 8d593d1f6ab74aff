// Requests answered by one document, not by a stream, for the service and the command line.
#pragma once

#include <variant>

#include "api/format/encode.hpp"
#include "api/identify.hpp"
#include "api/simulate.hpp"

namespace vines::api {

/// Output options of a request: its fields `format` and `fields`.
struct AnswerForm {
    std::optional<Format> format;     ///< empty: chosen from the Accept header
    std::vector<std::string> fields;  ///< paths to keep; empty: everything
};

/// A valid request with its output options.
struct AnswerRequest {
    std::variant<SimulateRequest, ManifoldRequest, IdentifyRequest> computation;
    AnswerForm form;
    Provenance provenance;
};

/// The body of an identification: a CSV file, or the JSON that also holds the fields.
struct MeasurementBody {
    std::string_view text;
    bool is_columns;  ///< true: `text` is CSV and the fields are separate; false: JSON
};

/// Reads a request to /v1/simulate, /v1/manifold or /v1/identify; Problem 422 for another route.
/// Problem 413 for a measurement or fields larger than `limits`; Cancelled once limits.gives_up().
AnswerRequest read_answer_request(
    const std::string& route, Json fields, const MeasurementBody& body = {},
    const ReadLimits& limits = {});

/// Limits and callbacks of a computation.
struct ComputeOptions {
    Stop stop = {};
    std::size_t most_bytes = any_size;          ///< JSON of a simulation; see simulate_in_parts()
    std::size_t most_kept = most_kept_impacts;  ///< longer impact lists are streamed; JSON only
    std::size_t most_fitted = any_size;         ///< impacts of a record that are fitted
    std::function<void(std::size_t bytes)> begins = {};  ///< see simulate_in_parts()
    /// Called as an identification reaches each stage and round.
    std::function<void(IdentificationStage, int round)> reached = {};
};

/// The answer, reduced to the requested fields, with its provenance.
Answer compute_answer(AnswerRequest request, const ComputeOptions& options);

}  // namespace vines::api
