// The parts of the OpenAPI document, each made in a file of its own.
#pragma once

#include <functional>

#include "api/openapi/json_schema.hpp"
#include "api/schema/tables.hpp"

namespace vines::api::document {

// Schemas: each function adds those of its file to components/schemas, by name.

void add_requests(Json& schemas);            // requests.cpp
void add_systems(Json& schemas);             // systems.cpp: parameters and provenance
void add_exponents(Json& schemas);           // exponents.cpp
void add_manifolds(Json& schemas);           // simulation.cpp: the part and the response
void add_simulation(Json& schemas);          // simulation.cpp
void add_sweep_lines(Json& schemas);         // sweep_lines.cpp
void add_continuation_lines(Json& schemas);  // continuation_lines.cpp
void add_design_lines(Json& schemas);        // design_lines.cpp
void add_identification(Json& schemas);      // identification.cpp
void add_service(Json& schemas);             // service.cpp: tables, presets, version, problems

// Keys that several responses have.

/// version, parameters (with the named schema), warnings.
Keys answer_keys(const std::string& parameters);
/// The same with provenance.
Keys sealed_keys(const std::string& parameters);
Json multipliers_schema();  // continuation_lines.cpp
/// A line of a stream: `type`, then these keys.
Json line_of(const char* type, const Keys& keys);
/// An optional key for each parameter that can be swept and for which is_kept() is true.
Keys swept_keys(
    const Json& value, const std::string& description,
    const std::function<bool(const Field&)>& is_kept = [](const Field&) { return true; });
/// One of these schemas, selected by the key `type`: {value of type, name of the schema}.
Json by_type(const std::vector<std::pair<std::string, std::string>>& schemas);
/// Columns of a Poincare section at impact, without tau.
Keys impact_section_keys();
/// Columns of a stroboscopic section, without tau.
Keys stroboscopic_keys();
/// Four numbers; null for minus infinity and for an exponent that is not converged.
Json four_exponents();
/// `final` and `status`.
Keys final_keys();

/// The fields as query parameters; `example`: values of some of them, which together are a valid
/// request.
Json query_of(const FieldTable& fields, const Json& example);

// Responses and headers.

/// components/responses, components/headers.
Json response_components();
Json header_components();
/// References to the response components of these statuses.
Json responses_of(const std::vector<int>& statuses);
/// The statuses with which every operation can respond.
std::vector<int> common_statuses();
/// X-Request-ID and the named header components.
Json headers_of(const std::vector<std::string>& names);

// Examples.

/// Examples of an operation, each a valid request: {name: {summary, value}} for its request body,
/// or the fields of its query.
Json request_example(const char* operation);
/// The response with this schema to the first request example. Null where it is too long.
Json answer_example(const char* schema);

}  // namespace vines::api::document
