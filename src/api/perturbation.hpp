// The field `perturbation` of a request, and its part of the answer.
#pragma once

#include <optional>

#include "api/merged_fields.hpp"
#include "core/analysis/perturbation.hpp"

namespace vines::api {

/// The perturbation of the initial state; nullopt if not given or invalid, which adds to `errors`.
/// The unperturbed start must be valid.
std::optional<State> read_perturbation(
    const MergedFields& fields, const Parameters& parameters, const State& start,
    std::vector<FieldError>& errors);

Json describe_perturbation(Perturbation&& perturbation);

}  // namespace vines::api
