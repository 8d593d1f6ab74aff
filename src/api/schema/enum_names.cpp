#include "api/schema/enum_names.hpp"

namespace vines::api {

namespace {

constexpr EnumName<FieldType> field_types[] = {
    {FieldType::number, "number"},     {FieldType::integer, "integer"},
    {FieldType::choice, "choice"},     {FieldType::choices, "choices"},
    {FieldType::interval, "interval"}, {FieldType::intervals, "intervals"},
    {FieldType::integers, "integers"}, {FieldType::numbers, "numbers"},
    {FieldType::object, "object"},     {FieldType::objects, "objects"}};

constexpr EnumName<Damping> dampings[] = {
    {Damping::equation_of_motion, "equation_of_motion"}, {Damping::closed_form, "closed_form"}};

constexpr EnumName<Status> statuses[] = {
    {Status::ok, "ok"},
    {Status::minus_infinity, "minus_infinity"},
    {Status::not_converged, "not_converged"}};

constexpr EnumName<Verdict> verdicts[] = {
    {Verdict::chaotic, "chaotic"},
    {Verdict::regular, "regular"},
    {Verdict::not_decided, "not_decided"},
    {Verdict::none, nullptr}};

constexpr EnumName<SectionKind> sections[] = {
    {SectionKind::none, "none"},
    {SectionKind::impact, "impact"},
    {SectionKind::stroboscopic, "stroboscopic"}};

constexpr EnumName<Carry> carries[] = {
    {Carry::none, "none"}, {Carry::up, "up"}, {Carry::down, "down"}};

constexpr EnumName<Unknown> fitted_unknowns[] = {
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

}  // namespace

template <>
std::span<const EnumName<FieldType>> enum_names() {
    return field_types;
}
template <>
std::span<const EnumName<Damping>> enum_names() {
    return dampings;
}
template <>
std::span<const EnumName<Status>> enum_names() {
    return statuses;
}
template <>
std::span<const EnumName<Verdict>> enum_names() {
    return verdicts;
}
template <>
std::span<const EnumName<SectionKind>> enum_names() {
    return sections;
}
template <>
std::span<const EnumName<Carry>> enum_names() {
    return carries;
}
template <>
std::span<const EnumName<Unknown>> enum_names() {
    return fitted_unknowns;
}

}  // namespace vines::api
