// The table of /v1/identify: what of /v1/simulate holds for a record, and how to read its columns.
#include "api/schema/tables.hpp"
#include "api/schema/words.hpp"

namespace vines::api {

namespace {

/// A field of /v1/simulate as a record sees it: some of the system is measured, not assumed.
Field of_record(Field f) {
    if (f.name == "F" || f.name == "G") f.description += "; of a record it is fitted";
    if (f.name == "R") {
        f.fallback = nullptr;
        f.fallback_note = "estimated, each wall's from its impacts";
    }
    if (f.name == "m1" || f.name == "k1")
        f.fallback_note =
            "required for a record, or a preset: they give omega0, by which time is scaled";
    return f;
}

FieldTable column_rows() {
    return {
        {.name = "time_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of time",
         .fallback_note = "time_s, or one that begins with time or t"},
        {.name = "displacement_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of displacement",
         .fallback_note = "displacement_m, or one that begins with displacement or x"},
        {.name = "acceleration_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of acceleration",
         .fallback_note = "acceleration_m_s2, or one that begins with acceleration or a"},
        {.name = "base_acceleration_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of the base's acceleration, which tells the forcing",
         .fallback_note = "base_acceleration_m_s2, or one that begins with base_acceleration; none "
                          "is needed"},
        {.name = "force_column",
         .type = FieldType::choice,
         .group = "record",
         .description = "name of the column of a force on m1 that drives it, in place of the base",
         .fallback_note = "force_N, or one that begins with force; none is needed"},
    };
}

FieldTable unit_rows() {
    return {
        {.name = "time_unit",
         .type = FieldType::choice,
         .group = "record",
         .description = "unit of time, where neither the column's name nor a row of units says one",
         .fallback = "s",
         .choices = {"s", "ms"}},
        {.name = "displacement_unit",
         .type = FieldType::choice,
         .group = "record",
         .description =
             "unit of displacement, where neither the column's name nor a row of units says one",
         .fallback = "m",
         .choices = {"m", "mm", "um"}},
        {.name = "acceleration_unit",
         .type = FieldType::choice,
         .group = "record",
         .description =
             "unit of acceleration, where neither the column's name nor a row of units says one",
         .fallback = "m/s2",
         .choices = {"m/s2", "g"}},
        {.name = "base_acceleration_unit",
         .type = FieldType::choice,
         .group = "record",
         .description = "unit of the base's acceleration, where neither the column's name nor a "
                        "row of units says one",
         .fallback = "m/s2",
         .choices = {"m/s2", "g"}},
        {.name = "force_unit",
         .type = FieldType::choice,
         .group = "record",
         .description =
             "unit of the force, where neither the column's name nor a row of units says one",
         .fallback = "N",
         .choices = {"N", "kN"}},
    };
}

FieldTable impact_rows() {
    return {
        {.name = "threshold",
         .group = "record",
         .unit = "standard deviations of the noise",
         .description = "height from which on a spike of the acceleration may be an impact",
         .fallback = 6,
         .range = Range{3, 1000}},
        {.name = "impact_times_s",
         .type = FieldType::numbers,
         .group = "record",
         .unit = "s",
         .description =
             "moments of the impacts, from an edited list: then they are not searched for",
         .fallback_note = "found from the record"},
    };
}

std::vector<std::string> fixable() {
    std::vector<std::string> names = all_words<Unknown>();
    names.insert(names.begin() + 1, {"F", "phase"});
    return names;
}

Field phase_row() {
    return {
        .name = "phase",
        .group = "record",
        .unit = "rad",
        .description =
            "of the base, which moves by F sin(2 pi f t + phase), t as in the record: where it is "
            "fixed",
        .fallback_note = "fitted; where it is fixed that of a channel of the forcing",
        .range = Range{-7, 7}};
}

Field fixed_row() {
    return {
        .name = "fixed",
        .type = FieldType::choices,
        .group = "record",
        .description =
            "what of a record is not fitted but taken as given: f, F, phase, omega0, zeta, b and R "
            "by the other fields, a sensor without fault",
        .fallback = Json::array(),
        .choices = fixable()};
}

Field include_row() {
    return {
        .name = "include",
        .type = FieldType::choices,
        .group = "output",
        .description =
            "parts of the answer beside the usual ones, of a record: motion, the fitted "
            "motion at its samples; direct_exponents, those of the paper's direct "
            "estimate with their histories",
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
