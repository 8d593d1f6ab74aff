// Names of the enumerations' values in requests and responses: one table for each enumeration.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "api/schema/field.hpp"
#include "core/measurement/unknowns.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

template <class Enum>
struct EnumName {
    Enum value;
    const char* name;  ///< null: JSON null stands for the value
};

/// The table of an enumeration.
template <class Enum>
std::span<const EnumName<Enum>> enum_names();

template <>
std::span<const EnumName<FieldType>> enum_names();
template <>
std::span<const EnumName<Damping>> enum_names();
template <>
std::span<const EnumName<Status>> enum_names();
template <>
std::span<const EnumName<Verdict>> enum_names();
template <>
std::span<const EnumName<SectionKind>> enum_names();
template <>
std::span<const EnumName<Carry>> enum_names();
/// The unknowns of a fit that a request can fix.
template <>
std::span<const EnumName<Unknown>> enum_names();

/// The name of a value; can be null. Throws std::logic_error if the table lacks the value.
template <class Enum>
const char* enum_name(Enum value) {
    for (const auto& entry : enum_names<Enum>())
        if (entry.value == value) return entry.name;
    throw std::logic_error("an enumeration's value without a name");
}

/// The value as JSON: its name, or null.
template <class Enum>
Json enum_json(Enum value) {
    const char* name = enum_name(value);
    return name ? Json(name) : Json(nullptr);
}

/// The value of this name, which check() has accepted; throws std::logic_error for another name.
template <class Enum>
Enum enum_value(std::string_view name) {
    for (const auto& entry : enum_names<Enum>())
        if (entry.name && name == entry.name) return entry.value;
    throw std::logic_error("no enumeration's value of the name " + std::string(name));
}

/// All names, in the order of the table: the choices of a field.
template <class Enum>
std::vector<std::string> enum_choices() {
    std::vector<std::string> choices;
    for (const auto& entry : enum_names<Enum>())
        if (entry.name) choices.push_back(entry.name);
    return choices;
}

}  // namespace vines::api
