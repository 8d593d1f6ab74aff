// A field of a request: its name, type, range, unit, default and description, and how its value is
// written in a query. Parsing, checks, defaults, GET /v1/parameters, the OpenAPI document, the
// command line and the page's form all follow from the tables of fields (tables.hpp).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "api/schema/json.hpp"

namespace vines::api {

enum class FieldType {
    number,
    integer,
    choice,     ///< one of the choices
    choices,    ///< an array of choices (in a query: separated by commas)
    interval,   ///< [from, to] (in a query: separated by a comma)
    intervals,  ///< an array of intervals (in a query: separated by semicolons)
    integers,   ///< an array of whole numbers
    numbers,    ///< an array of numbers (in a query: separated by commas); with a range also one
                ///< number in its place
    object,     ///< an object with sub-fields (in a query: name.field for each)
    objects     ///< an array of objects
};

/// A closed interval.
struct Range {
    double minimum, maximum;
};

using Choices = std::vector<std::string>;
struct Field;
using FieldTable = std::vector<Field>;

/// The range of a number, the choices of a string, or the sub-fields of an object.
using Limits = std::variant<std::monostate, Range, Choices, FieldTable>;
inline constexpr std::monostate any_value;
/// Prevents overflow of a number whose reader checks it against the range of its parameter.
inline constexpr Range any_number{-1e300, 1e300};

struct Field {
    Field(
        std::string name, std::string description, FieldType type, Limits limits = any_value,
        Json fallback = nullptr, std::string fallback_note = "", std::string unit = "",
        std::string symbol = "");

    std::string name;
    FieldType type;
    std::string group, unit, symbol, description;
    /// The default; null if it follows from other fields.
    Json fallback;
    std::string fallback_note;   ///< how the default follows from other fields
    std::optional<Range> range;  ///< every number and integer has one
    /// The permitted values of a choice or of choices; empty: any string. For objects: strings that
    /// are permitted in place of the array.
    Choices choices;
    /// Sub-fields of an object; empty if the reader of the request checks them.
    FieldTable fields;
};

/// The rows as one group.
FieldTable grouped(const char* group, FieldTable rows);
FieldTable operator+(FieldTable table, const FieldTable& more);

/// The field of this name; null if the table has none.
const Field* find(const FieldTable& table, const std::string& name);

/// The value of a field of the table in an object, otherwise the table's default.
Json value_or_default(const FieldTable& table, const Json& object, const char* name);

/// The name, of those known, that a mistyped name probably stands for; empty if none is similar.
/// Names and table must not be empty.
std::string nearest_name(std::span<const std::string> names, const std::string& name);
std::string nearest_name(const FieldTable& table, const std::string& name);

/// The value of a field of this type that a query's text stands for. Text that cannot be read as
/// this type stays a string, in whole or in part, which check() reports.
Json value_of_text(FieldType type, const std::string& text);

/// The parts of a separated list; none for an empty text.
std::vector<std::string> split(const std::string& text, char separator);

/// "one, two, three", for a sentence.
std::string joined(const std::vector<std::string>& items);

}  // namespace vines::api
