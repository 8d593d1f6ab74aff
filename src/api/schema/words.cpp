#include "api/schema/words.hpp"

namespace vines::api {

namespace {

constexpr Word<FieldType> field_types[] = {
    {FieldType::number, "number"},     {FieldType::integer, "integer"},
    {FieldType::choice, "choice"},     {FieldType::choices, "choices"},
    {FieldType::interval, "interval"}, {FieldType::intervals, "intervals"},
    {FieldType::integers, "integers"}, {FieldType::numbers, "numbers"},
    {FieldType::object, "object"},     {FieldType::objects, "objects"}};

constexpr Word<Damping> dampings[] = {
    {Damping::equation_of_motion, "equation_of_motion"}, {Damping::closed_form, "closed_form"}};

constexpr Word<Status> statuses[] = {
    {Status::ok, "ok"},
    {Status::minus_infinity, "minus_infinity"},
    {Status::not_converged, "not_converged"}};

constexpr Word<Verdict> verdicts[] = {
    {Verdict::chaotic, "chaotic"},
    {Verdict::regular, "regular"},
    {Verdict::not_decided, "not_decided"},
    {Verdict::none, nullptr}};

constexpr Word<SectionKind> sections[] = {
    {SectionKind::none, "none"},
    {SectionKind::impact, "impact"},
    {SectionKind::stroboscopic, "stroboscopic"}};

constexpr Word<Carry> carries[] = {{Carry::none, "none"}, {Carry::up, "up"}, {Carry::down, "down"}};

constexpr Word<Unknown> fitted_unknowns[] = {
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
std::span<const Word<FieldType>> words() {
    return field_types;
}
template <>
std::span<const Word<Damping>> words() {
    return dampings;
}
template <>
std::span<const Word<Status>> words() {
    return statuses;
}
template <>
std::span<const Word<Verdict>> words() {
    return verdicts;
}
template <>
std::span<const Word<SectionKind>> words() {
    return sections;
}
template <>
std::span<const Word<Carry>> words() {
    return carries;
}
template <>
std::span<const Word<Unknown>> words() {
    return fitted_unknowns;
}

}  // namespace vines::api
