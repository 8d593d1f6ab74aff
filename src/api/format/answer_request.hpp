// Requests that one JSON document answers: /v1/simulate, /v1/manifold, /v1/identify. Read, computed
// and reduced to the requested fields, the same for the service and the command line.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/format/encode.hpp"
#include "api/identify.hpp"
#include "api/provenance.hpp"
#include "api/schema/field.hpp"
#include "api/simulate.hpp"

namespace vines::api {

/// The parts of an answer and its format.
struct AnswerForm {
    std::optional<Format> format;     ///< none: by content negotiation
    std::vector<std::string> fields;  ///< paths to keep; empty: everything
};

/// Moves form_fields() out of a request's fields; `table` describes the others. If the request
/// selects parts of the answer but gives no `include`, `include` is set to those parts. Problem 422
/// for an invalid field.
AnswerForm take_form(Json& fields, const FieldTable& table);

/// Keeps of an answer what `fields` names, and always version, status, warnings and provenance.
/// Adds a warning for each name that matches nothing.
void keep_fields(Json& answer, const std::vector<std::string>& fields);

struct AnswerRequest {
    std::variant<SimulateRequest, ManifoldRequest, IdentifyRequest> computation;
    AnswerForm form;
    Provenance provenance;
};

/// The body of an identification: a CSV file, or the JSON that also holds the fields.
struct MeasurementBody {
    std::string_view text;
    bool is_columns;
};

/// Reads a request to /v1/simulate, /v1/manifold or /v1/identify. Problem 422 for an invalid field
/// or record, or another route; Problem 413 or Cancelled by `limits`.
AnswerRequest read_answer_request(
    const std::string& route, Json fields, const MeasurementBody& sent = {},
    const ReadLimits& limits = {});

/// Limits and callbacks of a computation.
struct ComputeOptions {
    Stop stop = {};
    std::size_t most_bytes = any_size;          ///< see simulate_in_parts()
    std::size_t most_kept = most_kept_impacts;  ///< see simulate_in_parts(); JSON only
    std::function<void(IdentificationStage, int round)> reached = {};
};

/// The answer, reduced to the requested fields, with its provenance. Throws the Problems of the
/// computation.
Answer compute_answer(AnswerRequest request, const ComputeOptions& options);

}  // namespace vines::api
