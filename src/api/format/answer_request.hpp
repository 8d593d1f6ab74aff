// Requests that are answered by one document, not by a stream: /v1/simulate, /v1/manifold,
// /v1/identify. The service and the command line read, compute and reduce them with these
// functions.
#pragma once

#include <variant>

#include "api/format/encode.hpp"
#include "api/identify.hpp"
#include "api/schema/field.hpp"
#include "api/simulate.hpp"

namespace vines::api {

/// Output options of a request: its fields `format` and `fields`.
struct AnswerForm {
    std::optional<Format> format;     ///< empty: chosen from the Accept header
    std::vector<std::string> fields;  ///< paths to keep; empty: everything
};

/// Removes the output options, form_fields(), from `fields` and returns them. `table` describes the
/// remaining fields: if it has `include` and the request gives `fields` but no `include`, `include`
/// is set to the parts that `fields` names. Throws Problem 422 for an invalid output option.
AnswerForm take_form(Json& fields, const FieldTable& table);

/// Removes everything from an answer except the paths in `fields`, version, status, warnings and
/// provenance. Adds a warning for each path that matches nothing. Empty `fields` keep everything.
void keep_fields(Json& answer, const std::vector<std::string>& fields);

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

/// Reads a request to /v1/simulate, /v1/manifold or /v1/identify. Throws Problem 422 for an invalid
/// field or record, or another route; Problem 413 for a measurement or fields larger than `limits`;
/// Cancelled once limits.gives_up() returns true.
AnswerRequest read_answer_request(
    const std::string& route, Json fields, const MeasurementBody& body = {},
    const ReadLimits& limits = {});

/// Limits and callbacks of a computation.
struct ComputeOptions {
    Stop stop = {};
    std::size_t most_bytes = any_size;          ///< JSON of a simulation; see simulate_in_parts()
    std::size_t most_kept = most_kept_impacts;  ///< longer impact lists are streamed; JSON only
    std::size_t most_fitted = any_size;         ///< impacts of a record that are fitted
    /// Called as an identification reaches each stage and round.
    std::function<void(IdentificationStage, int round)> reached = {};
};

/// The answer, reduced to the requested fields, with its provenance. Throws the Problems of the
/// computation.
Answer compute_answer(AnswerRequest request, const ComputeOptions& options);

}  // namespace vines::api
