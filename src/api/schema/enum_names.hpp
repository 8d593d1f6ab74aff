// Names of the enumerations' values in requests and responses: one table for each enumeration.
#pragma once

#include <array>
#include <stdexcept>
#include <string_view>

#include "api/schema/field.hpp"
#include "core/design/design.hpp"
#include "core/measurement/unknowns.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

template <class Enum>
struct EnumName {
    Enum value;
    const char* name;  ///< null: JSON null stands for the value
};

/// The table of an enumeration: an array of any length, for each one below.
template <class Enum>
inline constexpr std::array<EnumName<Enum>, 0> enum_names;

template <>
inline constexpr EnumName<FieldType> enum_names<FieldType>[] = {
    {FieldType::number, "number"},     {FieldType::integer, "integer"},
    {FieldType::choice, "choice"},     {FieldType::choices, "choices"},
    {FieldType::interval, "interval"}, {FieldType::intervals, "intervals"},
    {FieldType::integers, "integers"}, {FieldType::numbers, "numbers"},
    {FieldType::object, "object"},     {FieldType::objects, "objects"}};

template <>
inline constexpr EnumName<Damping> enum_names<Damping>[] = {
    {Damping::equation_of_motion, "equation_of_motion"}, {Damping::closed_form, "closed_form"}};

template <>
inline constexpr EnumName<Status> enum_names<Status>[] = {
    {Status::ok, "ok"},
    {Status::minus_infinity, "minus_infinity"},
    {Status::not_converged, "not_converged"}};

template <>
inline constexpr EnumName<Verdict> enum_names<Verdict>[] = {
    {Verdict::chaotic, "chaotic"},
    {Verdict::regular, "regular"},
    {Verdict::not_decided, "not_decided"},
    {Verdict::none, nullptr}};

template <>
inline constexpr EnumName<SectionKind> enum_names<SectionKind>[] = {
    {SectionKind::none, "none"},
    {SectionKind::impact, "impact"},
    {SectionKind::stroboscopic, "stroboscopic"}};

template <>
inline constexpr EnumName<Carry> enum_names<Carry>[] = {
    {Carry::none, "none"}, {Carry::up, "up"}, {Carry::down, "down"}};

template <>
inline constexpr EnumName<Objective> enum_names<Objective>[] = {
    {Objective::x_max, "x_max"},
    {Objective::x_rms, "x_rms"},
    {Objective::x_relative_max, "x_relative_max"},
    {Objective::x_acceleration_max, "x_acceleration_max"},
    {Objective::impact_speed_max, "impact_speed_max"},
    {Objective::impulse_max, "impulse_max"},
    {Objective::impacts_per_second, "impacts_per_second"},
    {Objective::decay_time, "decay_time"}};

template <>
inline constexpr EnumName<Toleranced> enum_names<Toleranced>[] = {
    {Toleranced::m1, "m1"},
    {Toleranced::k1, "k1"},
    {Toleranced::f0, "f0"},
    {Toleranced::c1, "c1"},
    {Toleranced::damping_ratio, "damping_ratio"},
    {Toleranced::m2, "m2"},
    {Toleranced::b, "b"},
    {Toleranced::R, "R"},
    // The amplitude has the name of what excites the host.
    {Toleranced::amplitude, "acceleration"},
    {Toleranced::amplitude, "F"},
    {Toleranced::amplitude, "initial_velocity"},
    {Toleranced::amplitude, "load_factor"}};

/// The unknowns of a fit that a request can fix.
template <>
inline constexpr EnumName<Unknown> enum_names<Unknown>[] = {
    {Unknown::Omega, "f"},
    {Unknown::x_offset, "displacement_offset"},
    {Unknown::x_drift, "displacement_drift"},
    {Unknown::x_gain, "displacement_gain"},
    {Unknown::x_delay, "displacement_delay_s"},
    {Unknown::a_offset, "acceleration_offset"},
    {Unknown::a_drift, "acceleration_drift"},
    {Unknown::stiffness, "omega0"},
    {Unknown::damping, "zeta"},
    {Unknown::b, "b"},
    {Unknown::R_plus, "R_plus"},
    {Unknown::R_minus, "R_minus"}};

/// The name of a value; can be null. Throws std::logic_error if the table lacks the value.
template <class Enum>
const char* enum_name(Enum value) {
    for (const auto& entry : enum_names<Enum>)
        if (entry.value == value) return entry.name;
    throw std::logic_error("a value of an enumeration has no name");
}

/// The value as JSON: its name, or null.
template <class Enum>
Json enum_json(Enum value) {
    const char* name = enum_name(value);
    return name ? Json(name) : Json(nullptr);
}

/// The value of a name that the check of the field has accepted; throws std::logic_error for
/// another name.
template <class Enum>
Enum enum_value(std::string_view name) {
    for (const auto& entry : enum_names<Enum>)
        if (entry.name && name == entry.name) return entry.value;
    throw std::logic_error("no value of an enumeration is named " + std::string(name));
}

/// All names, in the order of the table: the choices of a field.
template <class Enum>
std::vector<std::string> enum_choices() {
    std::vector<std::string> choices;
    for (const auto& entry : enum_names<Enum>)
        if (entry.name) choices.push_back(entry.name);
    return choices;
}

}  // namespace vines::api
