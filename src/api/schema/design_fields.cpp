// The table of /v1/design.
#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

FieldTable tolerance_rows() {
    using enum FieldType;
    const FieldTable distribution = {
        {"normal", "[mean, standard deviation]", numbers, any_value, nullptr,
         "required, or uniform"},
        {"uniform", "[from, to]", interval, any_value, nullptr, "required, or normal"},
        {"of", "value: in its unit; factor: on the value of the best absorber or of the host",
         choice, Choices{"value", "factor"}, "value"}};
    FieldTable rows;
    for (const std::string& name : enum_choices<Toleranced>())
        rows.push_back({name, "distribution of " + name, object, distribution, nullptr, "none"});
    return rows;
}

/// A load as of a run.
Field forcing_row() {
    Field forcing = *find(simulate_fields(), "forcing");
    forcing.description =
        "load instead of f and acceleration or F: a record or a formula, as of a run. The absorber "
        "is judged from rest over the length of the load, or over transient_cycles and cycles of "
        "the host for one without end or a shock";
    forcing.fallback_note = "none";
    return forcing;
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
const FieldTable& design_fields() {
    using enum FieldType;
    static const FieldTable table = grouped(
        "design",
        {{"base",
          "the host in SI: m1, k1 or f0, c1 or damping_ratio, m2 or mass_ratio, damping; without "
          "f, F, b and R",
          object, any_value, nullptr, "required"},
         {"f", "band of the forcing, or one frequency", interval, any_value, nullptr,
          "required, or forcing or initial_velocity", "Hz"},
         {"acceleration",
          "amplitude of the base's acceleration, constant over the band; a range stands for all "
          "amplitudes in it",
          interval, any_value, nullptr, "required, or F", "m/s^2"},
         {"F", "amplitude of the base's displacement instead of acceleration", interval, any_value,
          nullptr, "required, or acceleration", "m"},
         forcing_row(),
         {"initial_velocity",
          "velocity of m1 after an impulse, instead of a load; a range stands for all in it. The "
          "absorber is judged from there on over cycles of the host",
          interval, any_value, nullptr, "none", "m/s"},
         {"b", "smallest and largest clearance, or one", interval, any_value, nullptr,
          "from 5 to 120 % of the largest amplitude without absorber", "m"},
         {"R", "restitution coefficients to choose from, or one", numbers, any_value,
          Json{0.1, 0.2, 0.4, 0.6, 0.8}, "", dimensionless},
         {"m2", "masses of the ball to choose from, or one", numbers, any_value, nullptr,
          "that of base", "kg"},
         {"objective",
          "what shall be small: largest |x| or its rms, largest distance from the base, largest "
          "|x''| of m1, the fastest impact, or, with initial_velocity, the time in which the "
          "energy falls to a tenth; the default with forcing is x_relative_max, with "
          "initial_velocity decay_time",
          choice,
          Choices{
              "x_max", "x_rms", "x_relative_max", "x_acceleration_max", "impact_speed_max",
              "decay_time"},
          "x_max"},
         {"over", "worst: its largest value over band and amplitudes; mean: its mean", choice,
          Choices{"worst", "mean"}, "worst"},
         {"starts",
          "default set: the worst of four starts and of motions continued from neighbours; one: "
          "the default start",
          choice, Choices{"default set", "one"}, "default set"},
         {"b_count", "values of b in the first map", integer, Range{2, 400}, 40, "", dimensionless},
         {"f_count", "frequencies in the first map", integer, Range{2, 400}, 41, "", dimensionless},
         {"transient_cycles", "cycles before each measurement", integer, Range{0, 1e5}, 100, "",
          dimensionless},
         {"cycles", "cycles of each measurement", integer, Range{20, 1e5}, 200, "", dimensionless},
         {"tolerances",
          "scatter of values, each {\"normal\": [mean, standard deviation]} or {\"uniform\": "
          "[from, to]}, with \"of\": \"factor\" of a factor",
          object, tolerance_rows(), nullptr, "none"},
         {"samples", "samples of the tolerances", integer, Range{1, 1e6}, 200},
         {"seed", "equal seeds give equal samples", integer, Range{0, 1e9}, 1},
         {"indices", "zero-based indices of the samples to compute", integers, any_value, nullptr,
          "all"}});
    return table;
}

}  // namespace vines::api
