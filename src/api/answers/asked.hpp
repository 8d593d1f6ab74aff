// What is asked of a route that answers at its end, and that answer: the same for the service and
// the command line.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <variant>

#include "api/format/answer_form.hpp"
#include "api/identify.hpp"
#include "api/provenance.hpp"
#include "api/simulate.hpp"

namespace vines::api {

struct Asked {
    std::variant<SimulateRequest, ManifoldRequest, IdentifyRequest> computation;
    AnswerForm form;
    Provenance provenance;
};

/// What came with the fields of an identification: a file of columns, or the JSON that they stand
/// in.
struct Sent {
    std::string_view text;
    bool is_columns;
};

/// Of /v1/simulate, /v1/manifold or /v1/identify. Problem 422 where a field, or the record, is at
/// fault, or the route is another one; BrokenOff and 413 where a record goes beyond `reading`.
Asked read_asked(
    const std::string& route, Json fields, const Sent& sent = {}, const Reading& reading = {});

/// What an answer is made with.
struct Means {
    Stop stop = {};
    std::size_t most_bytes = any_size;          ///< see fit_answer()
    std::size_t most_kept = most_kept_impacts;  ///< see simulate_in_parts(), for JSON
    std::function<void(IdentificationStage, int round)> reached = {};
};

/// Thinned, with its provenance. Problems as those of what computes it.
Answer answered(Asked asked, const Means& means);

}  // namespace vines::api
