// The one table of request fields. Parsing, validation, defaults, GET /v1/parameters and the page's
// form all follow from it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/problem.hpp"

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
    object,     ///< fields of their own
    objects     ///< an array of such
};

struct Field {
    std::string name;
    FieldType type;
    std::string group, unit, symbol, description;
    /// What holds when the field is left out; null where that follows from other fields.
    Json fallback;
    std::string fallback_note;  ///< and from which
    std::optional<double> minimum, maximum;
    std::vector<std::string> choices;
};

/// The longest run, in tau and in forcing cycles: what is kept of each cycle must fit into memory.
inline constexpr double longest_run = 1e7;
inline constexpr double most_cycles = 2e6;

/// In place of a list of starts.
inline constexpr const char* default_set_of_starts = "default set";

/// The fields of /v1/simulate, in the order in which a form shows them.
const std::vector<Field>& simulate_fields();

/// The fields of /v1/sweep; those of its `base`; those of an entry of `axes`; those of an entry of
/// `starts`.
const std::vector<Field>& sweep_fields();
const std::vector<Field>& sweep_base_fields();
const std::vector<Field>& axis_fields();
const std::vector<Field>& start_fields();

/// The fields of /v1/identify, beside the record itself.
const std::vector<Field>& identify_fields();

/// The fields of /v1/manifold.
const std::vector<Field>& manifold_fields();

/// The answer of GET /v1/parameters: the fields of /v1/simulate, and those of the other routes.
Json describe_fields();

/// The object that a query string's pairs stand for, typed by the table; what cannot be read as its
/// field's type stays text and is found by `check`. Problem 400 for a name that comes twice.
Json from_query(
    const std::vector<Field>& fields,
    const std::vector<std::pair<std::string, std::string>>& query);

/// The faults that show field by field, up to most_errors: unknown names, wrong types, out of
/// range, NaN.
std::vector<FieldError> check(const std::vector<Field>& fields, const Json& object);

}  // namespace vines::api
