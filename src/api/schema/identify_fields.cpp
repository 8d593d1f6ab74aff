// The table of /v1/identify: the fields of /v1/simulate that apply to a record, and how to read the
// columns of the record.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

// g is the standard gravity.
const std::vector<Unit> acceleration_units = {
    {"m/s2", 1, {"m/s2", "m_s2", "ms-2", "m/s/s"}},
    {"mm/s2", 1e-3, {"mm/s2", "mm_s2", "mms-2", "mm/s/s"}},
    {"g", 9.80665, {"g"}}};

const std::vector<Unit> displacement_units = {
    {"m", 1, {"m"}}, {"mm", 1e-3, {"mm"}}, {"um", 1e-6, {"um"}}};

/// Adapts a field of /v1/simulate to a record: some of the system is measured, not given.
void adapt_to_record(Field& f) {
    if (f.name == "F" || f.name == "G") f.description += "; fitted if there is a record";
    if (f.name == "R") {
        f.fallback = nullptr;
        f.fallback_note = "estimated for each wall from its impacts";
    }
    if (f.name == "m1" || f.name == "k1")
        f.fallback_note = "required for a record, unless a preset gives it: omega0 scales the time";
}

Field column_row(const Channel& c) {
    return {
        c.name + "_column",
        "name of the column of " + (c.forcing.empty() ? c.quantity : c.forcing),
        FieldType::choice,
        any_value,
        nullptr,
        fmt::format(
            "{}, or the first name that begins with {}{}", c.column,
            fmt::join(c.beginnings, " or "), c.forcing.empty() ? "" : "; optional")};
}

Field unit_row(const Channel& c) {
    return {
        c.name + "_unit",
        "unit of " + c.quantity + ", unless the column's name or a row of units gives one",
        FieldType::choice, unit_names(c), c.units[0].name};
}

std::vector<std::string> fixable() {
    std::vector<std::string> names = enum_choices<Unknown>();
    names.insert(names.begin() + 1, {"F", "phase"});
    return names;
}

FieldTable record_rows() {
    using enum FieldType;
    FieldTable rows = {
        {"fixed",
         "quantities that are not fitted to the record: f, F, phase, omega0, zeta, b and R keep "
         "the values of the other fields, a sensor counts as free of errors",
         choices, fixable(), Json::array()},
        {"phase",
         "phase of the base, which moves by F sin(2 pi f t + phase), t as in the record; used "
         "if fixed contains phase",
         number, Range{-7, 7}, nullptr, "fitted; if fixed, the phase of the forcing channel",
         "rad"}};
    const std::vector<const Channel*> channels = {
        &time_channel,
        &displacement_channel,
        &acceleration_channel,
        &base_acceleration_channel,
        &base_displacement_channel,
        &force_channel};
    for (const Channel* channel : channels) rows.push_back(column_row(*channel));
    for (const Channel* channel : channels) rows.push_back(unit_row(*channel));
    rows.push_back(
        {"threshold", "smallest height at which a spike of the acceleration can be an impact",
         number, Range{3, 1000}, 6, "", "standard deviations of the noise"});
    rows.push_back(
        {"impact_times_s",
         "times of the impacts, for example an edited list; replaces their detection", numbers,
         any_value, nullptr, "detected in the record", "s"});
    for (const std::string name : {"m1", "c1", "k1", "m2"})
        rows.push_back(
            {name + "_uncertainty",
             "relative standard error of the given " + name +
                 "; for a record it becomes part of the standard errors of b, R and the other "
                 "fitted values",
             number, Range{0, 0.5}, 0});
    return rows;
}

FieldTable make_identify_fields() {
    using enum FieldType;
    FieldTable table = simulate_fields_where([](const Field& f) {
        return is_of_system(f) || f.name == "exponents" || f.name == "max_points" ||
               f.name == "friction" || f.name == "mu" || f.name.starts_with("restitution");
    });
    for (Field& field : table) adapt_to_record(field);
    const Field include = {
        "include",
        "additional parts of the response for a record: motion, the fitted motion at the samples; "
        "direct_exponents, exponents with histories by the direct method of the paper",
        choices, Choices{"motion", "direct_exponents"}, Json::array()};
    return table + grouped("output", {include}) + grouped("record", record_rows());
}

}  // namespace

const Channel time_channel{
    .name = "time",
    .column = "time_s",
    .beginnings = {"time", "t"},
    .units = {{"s", 1, {"s", "sec", "hh:mm:ss"}}, {"ms", 1e-3, {"ms", "msec"}}},
    .quantity = "time"};
const Channel displacement_channel{
    .name = "displacement",
    .column = "displacement_m",
    .beginnings = {"displacement", "x"},
    .units = displacement_units,
    .quantity = "displacement"};
const Channel acceleration_channel{
    .name = "acceleration",
    .column = "acceleration_m_s2",
    .beginnings = {"acceleration", "a"},
    .units = acceleration_units,
    .quantity = "acceleration"};
const Channel base_acceleration_channel{
    .name = "base_acceleration",
    .column = "base_acceleration_m_s2",
    .beginnings = {"base_acceleration"},
    .units = acceleration_units,
    .quantity = "the base's acceleration",
    .forcing = "the base's acceleration, which gives the forcing"};
const Channel base_displacement_channel{
    .name = "base_displacement",
    .column = "base_displacement_m",
    .beginnings = {"base_displacement"},
    .units = displacement_units,
    .quantity = "the base's displacement",
    .forcing = "the base's displacement, which gives the forcing"};
const Channel force_channel{
    .name = "force",
    .column = "force_N",
    .beginnings = {"force"},
    .units = {{"N", 1, {"n"}}, {"kN", 1e3, {"kn"}}},
    .quantity = "the force",
    .forcing = "a force on m1 that drives it instead of the base"};

std::vector<std::string> unit_names(const Channel& channel) {
    std::vector<std::string> names;
    for (const Unit& unit : channel.units) names.push_back(unit.name);
    return names;
}

const FieldTable& identify_fields() {
    static const FieldTable table = make_identify_fields();
    return table;
}

}  // namespace vines::api
