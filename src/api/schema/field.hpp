// A field of a request, its form in a query, and its check. Parsing, checks, defaults, GET
// /v1/parameters, the OpenAPI document, the command line and the page's form all follow from the
// tables of fields (tables.hpp).
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace vines::api {

/// The JSON type of requests and responses, which keeps the order of the keys.
using Json = nlohmann::ordered_json;

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

/// Prevents overflow of a number whose reader checks it against the range of its parameter.
inline constexpr Range any_number{-1e300, 1e300};
/// The unit of a dimensionless number.
inline constexpr const char* dimensionless = "dimensionless";

/// The values that a field can hold.
struct FieldKind {
    FieldType type;
    std::string unit, symbol;
    std::optional<Range> range;  ///< every number and integer has one
    /// The permitted values of a choice or of choices; empty: any string. For objects: strings that
    /// are permitted in place of the array.
    Choices choices;
    /// Sub-fields of an object; empty if the reader of the request checks them.
    FieldTable fields;
};

/// How a default follows from other fields.
struct Note {
    std::string text;
};

struct Field : FieldKind {
    Field(std::string name, FieldKind kind, Json fallback, std::string description);
    Field(std::string name, FieldKind kind, Note fallback, std::string description);

    std::string name, group, description;
    Json fallback;  ///< the default; null if it follows from other fields
    std::string fallback_note;
};

/// Names for the rows of tables: number({0, 1}, "m", "b") is a FieldKind.
namespace kinds {

template <FieldType type, class Limits>
struct KindOf {
    FieldKind operator()(
        Limits limits = {}, const std::string& unit = "", const std::string& symbol = "") const {
        FieldKind kind{type, unit, symbol, {}, {}, {}};
        if constexpr (std::is_same_v<Limits, Choices>) kind.choices = std::move(limits);
        else if constexpr (std::is_same_v<Limits, FieldTable>) kind.fields = std::move(limits);
        else kind.range = limits;
        return kind;
    }
};
inline constexpr KindOf<FieldType::number, Range> number;
inline constexpr KindOf<FieldType::integer, Range> integer;
inline constexpr KindOf<FieldType::choice, Choices> choice;
inline constexpr KindOf<FieldType::choices, Choices> choices;
inline constexpr KindOf<FieldType::interval, std::optional<Range>> interval;
inline constexpr KindOf<FieldType::intervals, std::optional<Range>> intervals;
inline constexpr KindOf<FieldType::integers, std::optional<Range>> integers;
inline constexpr KindOf<FieldType::numbers, std::optional<Range>> numbers;
inline constexpr KindOf<FieldType::object, FieldTable> json_object;
inline constexpr KindOf<FieldType::objects, Choices> json_objects;

inline const Note none{"none"}, required{"required"};

}  // namespace kinds

/// The rows as one group.
FieldTable grouped(const char* group, FieldTable rows);
FieldTable operator+(FieldTable table, const FieldTable& more);

/// The field of this name; null if the table has none.
const Field* find(const FieldTable& table, const std::string& name);

/// The fields of an object, with the defaults of a table for those that it lacks. Refers to both.
struct WithDefaults {
    const FieldTable& table;
    const Json& object;

    Json operator[](const char* name) const {
        return object.contains(name) ? object[name] : find(table, name)->fallback;
    }
};

/// "; did you mean NAME?" for the name, of those known, that a mistyped name probably stands for;
/// empty if none is similar. Names and table must not be empty.
std::string did_you_mean(std::span<const std::string> names, const std::string& name);
std::string did_you_mean(const FieldTable& table, const std::string& name);

/// The value of a field of this type that a query's text stands for. Text that cannot be read as
/// this type stays a string, in whole or in part, which check() reports.
Json value_of_text(FieldType type, const std::string& text);

/// The parts of a separated list; none for an empty text.
std::vector<std::string> split(const std::string& text, char separator);

/// The text without blanks and tabs at its ends.
std::string_view trimmed(std::string_view text);

/// A letter of ASCII in lower case; other characters as they are.
inline char lower_case(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

/// f of each element of a list, a member or a function that returns a text.
template <class List, class F>
std::vector<std::string> texts_of(const List& list, const F& f) {
    std::vector<std::string> texts;
    for (const auto& element : list) texts.push_back(std::invoke(f, element));
    return texts;
}

/// "one, two, three", for a sentence.
std::string joined(const std::vector<std::string>& items);

// The check of a request, and the errors that it reports (check.cpp).

/// One invalid field of a request.
struct FieldError {
    std::string pointer;  ///< JSON Pointer to the field
    Json value;           ///< value in the request, abbreviated by beginning_of()
    Json range;           ///< [minimum, maximum], a list of choices, or null
    std::string detail;   ///< a sentence
};

/// Errors listed per request; further ones are only counted.
inline constexpr std::size_t most_errors = 20;

/// The errors that each field shows on its own, up to most_errors.
std::vector<FieldError> check(const FieldTable& table, const Json& object);

/// Adds the errors of a nested object, with `where` before their pointers.
void add_errors(
    const std::string& where, std::vector<FieldError> nested, std::vector<FieldError>& all);

/// The numbers in the field `indices`, ascending and without repetitions, or all below `count`. An
/// error for one that is not; `detail`: how many there are, "the sweep has 4 points".
std::vector<std::size_t> read_indices(
    const Json& object, std::size_t count, const std::string& detail,
    std::vector<FieldError>& errors);

/// Bytes of an invalid value that a response repeats.
inline constexpr std::size_t longest_echo = 200;

/// The first part of a value: its text agrees with that of the whole value over the first
/// 2 longest_echo bytes. Takes time and memory independent of the size of the value.
Json beginning_of(const Json& value);

}  // namespace vines::api
