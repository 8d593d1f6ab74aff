// A field of a request. Parsing, validation, defaults, GET /v1/parameters, the OpenAPI document and
// the page's form all follow from the tables of fields (tables.hpp).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/schema/json.hpp"

namespace vines::api {

enum class FieldType {
    number,
    integer,
    choice,     ///< one of the choices
    choices,    ///< an array of them (in a query: separated by commas)
    interval,   ///< [from, to] (in a query: separated by a comma)
    intervals,  ///< an array of them (in a query: separated by semicolons)
    integers,   ///< an array of whole numbers
    numbers,    ///< an array of numbers (in a query: separated by commas)
    object,     ///< fields of their own (in a query: name.field each)
    objects     ///< an array of such
};

/// Both ends belong to it.
struct Range {
    double minimum, maximum;
};

struct Field {
    std::string name;
    FieldType type = FieldType::number;
    std::string group = "", unit = "", symbol = "", description = "";
    /// What holds when the field is left out; null where that follows from other fields.
    Json fallback = nullptr;
    std::string fallback_note = "";   ///< and from which
    std::optional<Range> range = {};  ///< of a number or integer: each has one
    /// Of a choice or of choices, none: any word. Of objects: words that may stand in place of the
    /// array.
    std::vector<std::string> choices = {};
    /// Of an object that is checked with the others: its own.
    std::vector<Field> fields = {};
};

using FieldTable = std::vector<Field>;

/// Null where the table has no field of this name.
const Field* find(const FieldTable& table, const std::string& name);

}  // namespace vines::api
