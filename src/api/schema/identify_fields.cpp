// The table of /v1/identify, and the channels of a record.
#include <fmt/format.h>
#include <fmt/ranges.h>

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

const std::vector<Unit> time_units = {
    {"s", 1, {"s", "sec", "hh:mm:ss"}}, {"ms", 1e-3, {"ms", "msec"}}};

const std::vector<Unit> force_units = {{"N", 1, {"n"}}, {"kN", 1e3, {"kn"}}};

/// Adapts a field of /v1/simulate to a record: some of the system is measured, not given.
void adapt_to_record(Field& f) {
    if (f.name == "F" || f.name == "G") f.description += "; fitted unless impacts have a phase";
    if (f.name == "R") {
        f.fallback = nullptr;
        f.fallback_note = "estimated for each wall from its impacts";
    }
    if (f.name == "m1" || f.name == "k1")
        f.fallback_note = "required for a record, unless a preset gives it: omega0 scales the time";
}

Field column_row(const Channel& c) {
    return {
        c.name + "_column", kinds::choice(),
        Note{fmt::format(
            "{}, or the first name that begins with {}{}", c.column,
            fmt::join(c.beginnings, " or "), c.forcing.empty() ? "" : "; optional")},
        "name of the column of " + (c.forcing.empty() ? c.quantity : c.forcing)};
}

FieldTable record_rows() {
    using namespace kinds;
    std::vector<std::string> fixable = enum_choices<Unknown>();
    fixable.insert(fixable.begin() + 1, {"F", "phase"});
    FieldTable rows = {
        {"fixed", choices(fixable), Json::array(),
         "quantities that are not fitted to the record: f, F, phase, omega0, zeta, b and R keep "
         "the values of the other fields, a sensor counts as free of errors"},
        {"fit", choices({"mu", "R_of_speed"}), Json::array(),
         "laws of the ball to fit to the record as well: mu, its friction; R_of_speed, one slope "
         "of R against the relative speed for both walls; the given values are the initial ones"},
        {"phase", number({-7, 7}, "rad"),
         Note{"fitted; if fixed, the phase of the forcing channel"},
         "phase of the base, which moves by F sin(2 pi f t + phase), t as in the record; used "
         "if fixed contains phase"}};
    const std::vector<const Channel*> channels = {
        &time_channel,
        &displacement_channel,
        &acceleration_channel,
        &base_acceleration_channel,
        &base_displacement_channel,
        &force_channel};
    for (const Channel* channel : channels) rows.push_back(column_row(*channel));
    for (const Channel* channel : channels)
        rows.push_back(
            {channel->name + "_unit", choice(texts_of(channel->units, &Unit::name)),
             channel->units[0].name,
             "unit of " + channel->quantity +
                 ", unless the column's name or a row of units gives one"});
    rows.push_back(
        {"threshold", number({3, 1000}, "standard deviations of the noise"), 6,
         "smallest height at which a spike of the acceleration can be an impact"});
    rows.push_back(
        {"impact_times_s", numbers({}, "s"), Note{"detected in the record"},
         "times of the impacts, for example an edited list; replaces their detection"});
    for (const std::string name : {"m1", "c1", "k1", "m2"})
        rows.push_back(
            {name + "_uncertainty", number({0, 0.5}), 0,
             "relative standard error of the given " + name +
                 "; for a record it becomes part of the standard errors of b, R and the other "
                 "fitted values"});
    return rows;
}

FieldTable make_identify_fields() {
    using namespace kinds;
    FieldTable table = simulate_fields_where([](const Field& f) {
        return is_of_system(f) || f.name == "exponents" || f.name == "max_points" ||
               f.name == "friction" || f.name == "mu" || f.name.starts_with("restitution");
    });
    for (Field& field : table) adapt_to_record(field);
    const Field include = {
        "include", choices({"motion", "direct_exponents"}), Json::array(),
        "additional parts of the response for a record: motion, the fitted motion at the samples; "
        "direct_exponents, exponents with histories by the direct method of the paper"};
    return table + grouped("output", {include}) + grouped("record", record_rows());
}

}  // namespace

const Channel time_channel{"time", "time_s", {"time", "t"}, time_units, "time"};
const Channel displacement_channel{
    "displacement", "displacement_m", {"displacement", "x"}, displacement_units, "displacement"};
const Channel acceleration_channel{
    "acceleration", "acceleration_m_s2", {"acceleration", "a"}, acceleration_units, "acceleration"};
const Channel base_acceleration_channel{
    "base_acceleration",       "base_acceleration_m_s2",
    {"base_acceleration"},     acceleration_units,
    "the base's acceleration", "the base's acceleration, which gives the forcing"};
const Channel base_displacement_channel{
    "base_displacement",       "base_displacement_m",
    {"base_displacement"},     displacement_units,
    "the base's displacement", "the base's displacement, which gives the forcing"};
const Channel force_channel{"force",     "force_N",
                            {"force"},   force_units,
                            "the force", "a force on m1 that drives it instead of the base"};

const FieldTable& identify_fields() {
    static const FieldTable table = make_identify_fields();
    return table;
}

}  // namespace vines::api
