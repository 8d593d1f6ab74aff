#include "api/schema/field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vines::api {

namespace {

/// Every window costs a computation of the exponents and a part of the response.
constexpr std::size_t most_windows = 1000;

std::string pointer(const std::string& name) { return (Json::json_pointer() / name).to_string(); }

/// FieldError::range of this field.
Json range_of(const Field& f) {
    if (f.range) return Json::array({f.range->minimum, f.range->maximum});
    if (!f.choices.empty()) return f.choices;
    return nullptr;
}

/// A field and the list to which its errors are appended.
struct Checked {
    const Field& field;
    std::vector<FieldError>& errors;

    /// Appends an error; `where`: JSON Pointer relative to the field.
    void fail(const std::string& where, const Json& value, const std::string& detail) const {
        errors.push_back(
            {pointer(field.name) + where, beginning_of(value), range_of(field),
             field.name + " " + detail});
    }
    bool is_choice(const Json& value) const {
        return value.is_string() &&
               std::ranges::count(field.choices, value.get_ref<const std::string&>()) > 0;
    }
    bool is_permitted(const Json& value) const {
        return field.choices.empty() ? value.is_string() : is_choice(value);
    }
    /// Calls check(where, entry) for each entry of an array of this kind; `where` as in fail().
    template <class Check>
    void each(const Json& array, const std::string& kind, Check check) const {
        if (!array.is_array()) return fail("", array, "must be an array of " + kind);
        for (std::size_t i = 0; i < array.size() && errors.size() < most_errors; ++i)
            check("/" + std::to_string(i), array[i]);
    }
    /// The same for entries that are valid by themselves; `what`: the valid ones.
    template <class IsValid>
    void each(const Json& array, const std::string& kind, const std::string& what, IsValid is_valid)
        const {
        each(array, kind, [&](const std::string& where, const Json& entry) {
            if (!is_valid(entry)) fail(where, entry, "must hold only " + what);
        });
    }
};

std::string must_lie_in(const Range& range, const std::string& unit) {
    const bool has_unit = !unit.empty() && unit != dimensionless;
    return fmt::format(
        "must lie in [{}, {}]{}", range.minimum, range.maximum, has_unit ? " " + unit : "");
}

void check_number(const Checked& c, const Json& value) {
    if (!value.is_number()) return c.fail("", value, "must be a number");
    const double v = value.get<double>();
    const Range& range = *c.field.range;
    if (!(v >= range.minimum && v <= range.maximum))
        c.fail("", value, must_lie_in(range, c.field.unit));
    else if (c.field.type == FieldType::integer && v != std::floor(v))
        c.fail("", value, "must be a whole number");
}

void check_interval(const Checked& c, const std::string& where, const Json& v) {
    if (!v.is_array() || v.size() != 2 || !v[0].is_number() || !v[1].is_number())
        return c.fail(where, v, "must be two numbers, [from, to]");
    const double from = v[0], to = v[1];
    if (const auto& range = c.field.range) {
        if (!(from >= range->minimum && to <= range->maximum))
            c.fail(where, v, must_lie_in(*range, c.field.unit));
    } else if (!(from >= 0)) {
        c.fail(where + "/0", v[0], "must not begin before 0");
    }
    if (!(from < to)) c.fail(where, v, "must begin before it ends");
}

void check_field(const Checked& c, const Json& value) {
    const Field& f = c.field;
    switch (f.type) {
        case FieldType::number:
        case FieldType::integer: return check_number(c, value);
        case FieldType::choice:
            if (!c.is_permitted(value))
                c.fail(
                    "", value,
                    value.is_string() ? "must be one of " + joined(f.choices) : "must be a string");
            return;
        case FieldType::choices:
            return c.each(
                value, "strings", f.choices.empty() ? "strings" : joined(f.choices),
                [&](const Json& entry) { return c.is_permitted(entry); });
        case FieldType::interval: return check_interval(c, "", value);
        case FieldType::intervals:
            if (value.is_array() && value.size() > most_windows)
                return c.fail(
                    "", value.size(),
                    "must hold at most " + std::to_string(most_windows) + " intervals");
            return c.each(
                value, "intervals, [[from, to], ...]",
                [&](const std::string& where, const Json& v) { check_interval(c, where, v); });
        case FieldType::integers:
            return c.each(value, "whole numbers", "whole numbers >= 0", [](const Json& entry) {
                return entry.is_number_integer() && entry >= 0;
            });
        case FieldType::numbers:
            if (f.range && value.is_number()) return check_number(c, value);
            return c.each(
                value, "numbers", "numbers", [](const Json& entry) { return entry.is_number(); });
        case FieldType::object:
            if (!value.is_object()) return c.fail("", value, "must be an object");
            if (f.fields.empty()) return;  // the reader of the request checks it
            return add_errors(pointer(f.name), check(f.fields, value), c.errors);
        case FieldType::objects:  // the reader of the request checks each
            if (!value.is_array() && !c.is_choice(value))
                c.fail(
                    "", value,
                    "must be an array" +
                        (f.choices.empty() ? "" : " or \"" + joined(f.choices) + "\""));
            return;
    }
}

constexpr std::size_t longest_text = 2 * longest_echo;

/// Visits values depth first until `left` of them are copied: the text of each has at least two
/// bytes.
Json beginning(const Json& value, std::size_t& left) {
    if (left > 0) --left;
    if (value.is_string()) {
        const std::string_view text = value.get_ref<const std::string&>();
        return std::string(text.substr(0, longest_text));
    }
    if (value.is_array()) {
        Json part = Json::array();
        for (std::size_t k = 0; k < value.size() && left > 0; ++k)
            part.push_back(beginning(value[k], left));
        return part;
    }
    if (!value.is_object()) return value;
    Json::object_t part;
    for (const auto& [name, member] : value.get_ref<const Json::object_t&>()) {
        if (left == 0) break;
        part.emplace_back(name.substr(0, longest_text), beginning(member, left));
    }
    return part;
}

}  // namespace

std::vector<FieldError> check(const FieldTable& table, const Json& object) {
    std::vector<FieldError> errors;
    for (const auto& [name, value] : object.items()) {
        if (errors.size() >= most_errors) break;
        if (const Field* f = find(table, name)) check_field({*f, errors}, value);
        else
            errors.push_back(
                {pointer(name), beginning_of(value), nullptr,
                 "unknown field" + did_you_mean(table, name)});
    }
    return errors;
}

void add_errors(
    const std::string& where, std::vector<FieldError> nested, std::vector<FieldError>& all) {
    for (FieldError& e : nested) {
        e.pointer = where + e.pointer;
        all.push_back(std::move(e));
    }
}

std::vector<std::size_t> read_indices(
    const Json& object, std::size_t count, const std::string& detail,
    std::vector<FieldError>& errors) {
    std::vector<std::size_t> indices;
    if (!object.contains("indices")) {
        indices.resize(count);
        std::iota(indices.begin(), indices.end(), 0);
        return indices;
    }
    indices = object["indices"].get<std::vector<std::size_t>>();
    std::ranges::sort(indices);
    indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
    if (!indices.empty() && indices.back() >= count)
        errors.push_back(
            {"/indices", indices.back(), Json::array({0, count - 1}),
             detail + ", numbered from 0"});
    return indices;
}

Json beginning_of(const Json& value) {
    std::size_t left = longest_echo;
    return beginning(value, left);
}

}  // namespace vines::api
