// One axis of a sweep: a parameter and its values.
#pragma once

#include <string>
#include <vector>

#include "api/problem.hpp"

namespace vines::api {

struct Axis {
    std::string parameter;
    std::vector<double> values;
};

/// From {parameter, from, to, count, scale} or {parameter, values}, with at most so many values.
/// What is at fault is added to the errors, `where` in front of its pointers; then there are none.
Axis read_axis(
    const Json& given, const std::string& where, std::size_t most, std::vector<FieldError>& errors);

}  // namespace vines::api
