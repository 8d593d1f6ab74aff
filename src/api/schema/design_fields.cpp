// The table of /v1/design.
#include "api/schema/enum_names.hpp"
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

FieldTable tolerance_rows() {
    const FieldTable distribution = {
        {.name = "normal",
         .type = FieldType::numbers,
         .description = "[mean, standard deviation]",
         .fallback_note = "required, or uniform"},
        {.name = "uniform",
         .type = FieldType::interval,
         .description = "[from, to]",
         .fallback_note = "required, or normal"},
        choice(
            "of", "value: in its unit; factor: on the value of the best absorber or of the host",
            {"value", "factor"}, "value")};
    FieldTable rows;
    for (const std::string& name : enum_choices<Toleranced>())
        rows.push_back(
            {.name = name,
             .type = FieldType::object,
             .description = "distribution of " + name,
             .fallback_note = "none",
             .fields = distribution});
    return rows;
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
const FieldTable& design_fields() {
    Field forcing = *find(simulate_fields(), "forcing");
    forcing.description =
        "load instead of f and acceleration or F: a record or a formula, as of a run. The absorber "
        "is judged from rest over the length of the load, or over transient_cycles and cycles of "
        "the host for one without end or a shock";
    forcing.fallback_note = "none";
    static const FieldTable table = grouped(
        "design",
        {{.name = "base",
          .type = FieldType::object,
          .description = "the host in SI: m1, k1 or f0, c1 or damping_ratio, m2 or mass_ratio, "
                         "damping; without f, F, b and R",
          .fallback_note = "required"},
         {.name = "f",
          .type = FieldType::interval,
          .unit = "Hz",
          .description = "band of the forcing, or one frequency",
          .fallback_note = "required, or forcing or initial_velocity"},
         {.name = "acceleration",
          .type = FieldType::interval,
          .unit = "m/s^2",
          .description = "amplitude of the base's acceleration, constant over the band; a range "
                         "stands for all amplitudes in it",
          .fallback_note = "required, or F"},
         {.name = "F",
          .type = FieldType::interval,
          .unit = "m",
          .description = "amplitude of the base's displacement instead of acceleration",
          .fallback_note = "required, or acceleration"},
         forcing,
         {.name = "initial_velocity",
          .type = FieldType::interval,
          .unit = "m/s",
          .description = "velocity of m1 after an impulse, instead of a load; a range stands for "
                         "all in it. The absorber is judged from there on over cycles of the host",
          .fallback_note = "none"},
         {.name = "b",
          .type = FieldType::interval,
          .unit = "m",
          .description = "smallest and largest clearance, or one",
          .fallback_note = "from 5 to 120 % of the largest amplitude without absorber"},
         {.name = "R",
          .type = FieldType::numbers,
          .unit = dimensionless,
          .description = "restitution coefficients to choose from, or one",
          .fallback = Json::array({0.1, 0.2, 0.4, 0.6, 0.8})},
         {.name = "m2",
          .type = FieldType::numbers,
          .unit = "kg",
          .description = "masses of the ball to choose from, or one",
          .fallback_note = "that of base"},
         choice(
             "objective",
             "what shall be small: largest |x| or its rms, largest distance from the base, largest "
             "|x''| of m1, the fastest impact, or, with initial_velocity, the time in which the "
             "energy falls to a tenth; the default with forcing is x_relative_max, with "
             "initial_velocity decay_time",
             {"x_max", "x_rms", "x_relative_max", "x_acceleration_max", "impact_speed_max",
              "decay_time"},
             "x_max"),
         choice(
             "over", "worst: its largest value over band and amplitudes; mean: its mean",
             {"worst", "mean"}, "worst"),
         choice(
             "starts",
             "default set: the worst of four starts and of motions continued from neighbours; one: "
             "the default start",
             {"default set", "one"}, "default set"),
         integer("b_count", "values of b in the first map", {2, 400}, 40, dimensionless),
         integer("f_count", "frequencies in the first map", {2, 400}, 41, dimensionless),
         integer(
             "transient_cycles", "cycles before each measurement", {0, 1e5}, 100, dimensionless),
         integer("cycles", "cycles of each measurement", {20, 1e5}, 200, dimensionless),
         {.name = "tolerances",
          .type = FieldType::object,
          .description = "scatter of values, each {\"normal\": [mean, standard deviation]} or "
                         "{\"uniform\": [from, to]}, with \"of\": \"factor\" of a factor",
          .fallback_note = "none",
          .fields = tolerance_rows()},
         integer("samples", "samples of the tolerances", {1, 1e6}, 200),
         integer("seed", "equal seeds give equal samples", {0, 1e9}, 1),
         {.name = "indices",
          .type = FieldType::integers,
          .description = "zero-based indices of the samples to compute",
          .fallback_note = "all"}});
    return table;
}

}  // namespace vines::api
