// The table of /v1/identify: the fields of /v1/simulate that apply to a record, and how to read the
// columns of the record.
#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

/// A field of /v1/simulate, adapted to a record: some of the system is measured, not given.
Field of_record(Field f) {
    if (f.name == "F" || f.name == "G") f.description += "; fitted if there is a record";
    if (f.name == "R") {
        f.fallback = nullptr;
        f.fallback_note = "estimated for each wall from its impacts";
    }
    if (f.name == "m1" || f.name == "k1")
        f.fallback_note = "required for a record, unless a preset gives it: omega0 scales the time";
    return f;
}

FieldTable column_rows() {
    return {
        {.name = "time_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of time",
         .fallback_note = "time_s, or the first name that begins with time or t"},
        {.name = "displacement_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of displacement",
         .fallback_note = "displacement_m, or the first name that begins with displacement or x"},
        {.name = "acceleration_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of acceleration",
         .fallback_note =
             "acceleration_m_s2, or the first name that begins with acceleration or a"},
        {.name = "base_acceleration_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of the base's acceleration, which gives the forcing",
         .fallback_note = "base_acceleration_m_s2, or the first name that begins with "
                          "base_acceleration; optional"},
        {.name = "force_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of a force on m1 that drives it instead of the base",
         .fallback_note = "force_N, or the first name that begins with force; optional"},
    };
}

FieldTable unit_rows() {
    return {
        {.name = "time_unit",
         .type = FieldType::choice,
         .group = "record",
         .description = "unit of time, unless the column's name or a row of units gives one",
         .fallback = "s",
         .choices = {"s", "ms"}},
        {.name = "displacement_unit",
         .type = FieldType::choice,
         .group = "record",
         .description =
             "unit of displacement, unless the column's name or a row of units gives one",
         .fallback = "m",
         .choices = {"m", "mm", "um"}},
        {.name = "acceleration_unit",
         .type = FieldType::choice,
         .group = "record",
         .description =
             "unit of acceleration, unless the column's name or a row of units gives one",
         .fallback = "m/s2",
         .choices = {"m/s2", "g"}},
        {.name = "base_acceleration_unit",
         .type = FieldType::choice,
         .group = "record",
         .description =
             "unit of the base's acceleration, unless the column's name or a row of units "
             "gives one",
         .fallback = "m/s2",
         .choices = {"m/s2", "g"}},
        {.name = "force_unit",
         .type = FieldType::choice,
         .group = "record",
         .description = "unit of the force, unless the column's name or a row of units gives one",
         .fallback = "N",
         .choices = {"N", "kN"}},
    };
}

FieldTable impact_rows() {
    return {
        {.name = "threshold",
         .group = "record",
         .unit = "standard deviations of the noise",
         .description = "smallest height at which a spike of the acceleration can be an impact",
         .fallback = 6,
         .range = Range{3, 1000}},
        {.name = "impact_times_s",
         .type = FieldType::numbers,
         .group = "record",
         .unit = "s",
         .description =
             "times of the impacts, for example an edited list; replaces their detection",
         .fallback_note = "detected in the record"},
    };
}

std::vector<std::string> fixable() {
    std::vector<std::string> names = enum_choices<Unknown>();
    names.insert(names.begin() + 1, {"F", "phase"});
    return names;
}

Field phase_row() {
    return {
        .name = "phase",
        .group = "record",
        .unit = "rad",
        .description =
            "phase of the base, which moves by F sin(2 pi f t + phase), t as in the record; used "
            "if fixed contains phase",
        .fallback_note = "fitted; if fixed, the phase of the forcing channel",
        .range = Range{-7, 7}};
}

Field fixed_row() {
    return {
        .name = "fixed",
        .type = FieldType::choices,
        .group = "record",
        .description =
            "quantities that are not fitted to the record: f, F, phase, omega0, zeta, b and R keep "
            "the values of the other fields, a sensor counts as free of errors",
        .fallback = Json::array(),
        .choices = fixable()};
}

Field include_row() {
    return {
        .name = "include",
        .type = FieldType::choices,
        .group = "output",
        .description =
            "additional parts of the response for a record: motion, the fitted motion at the "
            "samples; direct_exponents, exponents with histories by the direct method of the paper",
        .fallback = Json::array(),
        .choices = {"motion", "direct_exponents"}};
}

FieldTable make_identify_fields() {
    FieldTable table;
    for (const Field& f : simulate_fields())
        if (is_of_system(f) || f.name == "exponents" || f.name == "max_points")
            table.push_back(of_record(f));
    table.push_back(include_row());
    table.push_back(fixed_row());
    table.push_back(phase_row());
    for (const auto& rows : {column_rows, unit_rows, impact_rows})
        for (Field& f : rows()) table.push_back(std::move(f));
    return table;
}

}  // namespace

const FieldTable& identify_fields() {
    static const FieldTable table = make_identify_fields();
    return table;
}

}  // namespace vines::api
