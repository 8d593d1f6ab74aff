// How an answer is told: which of its parts, in which format.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/format/encode.hpp"
#include "api/schema/field.hpp"

namespace vines::api {

struct AnswerForm {
    std::optional<Format> format;     ///< none: whatever the reader takes
    std::vector<std::string> fields;  ///< paths of what is kept; none: everything
};

/// Takes form_fields() out of those of a request, whose table has the others: where it says which
/// parts of the answer are kept and not which are computed, those are. Problem 422 where one is at
/// fault.
AnswerForm take_form(Json& fields, const FieldTable& table);

/// What an answer's `fields` name, and always version, status, warnings, among them a sentence
/// for each that names nothing.
void thin(Json& answer, const std::vector<std::string>& fields);

}  // namespace vines::api
