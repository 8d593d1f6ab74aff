// The schemas of the document: each function adds those of its routes by their names.
#pragma once

#include "api/schema/json.hpp"

namespace vines::api::document {

void add_requests(Json& schemas);
/// What the answers of several routes hold.
void add_systems(Json& schemas);
void add_exponents(Json& schemas);
void add_manifolds(Json& schemas);
/// Answers.
void add_simulation(Json& schemas);
void add_sweep_lines(Json& schemas);
void add_identification(Json& schemas);
/// What the service says of itself, and problems.
void add_service(Json& schemas);

}  // namespace vines::api::document
