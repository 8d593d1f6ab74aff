// The field `perturbation` of a request, and the part of the answer that it asks for.
#pragma once

#include <optional>

#include "api/layers.hpp"
#include "core/analysis/perturbation.hpp"

namespace vines::api {

/// The difference of the start that the field names; none where it is not given, or at fault: then
/// errors say so. The start itself is valid.
std::optional<State> read_perturbation(
    const Layered& fields, const Parameters& parameters, const State& start,
    std::vector<FieldError>& errors);

Json describe_perturbation(Perturbation&& perturbation);

}  // namespace vines::api
