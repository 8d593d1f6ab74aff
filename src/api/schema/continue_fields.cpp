// The table of /v1/continue.
#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

FieldTable continue_rows() {
    const auto limit = [](const char* name, const char* description, const char* required) {
        return Field{
            .name = name,
            .description = description,
            .fallback_note = required,
            .range = Range{-1e300, 1e300}};
    };
    return {
        {.name = "base",
         .type = FieldType::object,
         .description = "fields of /v1/simulate: system, reduced or SI, start, preset; it also "
                        "sets the parameter's value at which the continuation starts",
         .fallback = Json::object()},
        // The reader of the request checks the name and lists the valid ones.
        choice(
            "parameter", "name of a numeric parameter of the system, dimensionless or SI", {},
            nullptr, "required"),
        limit("from", "one end of the parameter's range", "required"),
        limit("to", "the other end", "required"),
        choice(
            "orbit",
            "the first orbit. settled: the one on which the base's motion settles, which is "
            "stable; stated: the one next to the base's start, which can be unstable",
            {"settled", "stated"}, "settled"),
        integer(
            "period_cycles", "period of the stated orbit in forcing cycles, or a multiple of it",
            {1, 64}, 1, dimensionless),
        integer(
            "transient_cycles", "cycles before the search for the settled orbit", {0, 1e6}, 200,
            dimensionless),
        integer(
            "cycles", "further cycles in which the motion must settle", {1, 1e6}, 1000,
            dimensionless),
        {.name = "resolution",
         .unit = dimensionless,
         .description = "largest step of the parameter as a fraction of its range; steps are "
                        "shorter where the orbit changes fast",
         .fallback = 0.01,
         .range = Range{1e-5, 1}},
        integer("points", "largest number of points of a branch", {2, 100000}, 2000, dimensionless),
        integer(
            "switch",
            "depth of branch switching: 1 also follows the branches that begin at flips and "
            "symmetry breakings, 2 those that begin on these, and so on; true is 2",
            {0, 6}, 0, dimensionless),
        choice(
            "curve",
            "follow the special points of this kind, instead of the branch, in two parameters",
            {"fold", "flip", "symmetry_breaking", "torus", "grazing"}, nullptr, "none"),
        choice(
            "second", "of a curve: name of the second parameter", {}, nullptr,
            "required for a curve"),
        limit("second_from", "of a curve: one end of its range", "required for a curve"),
        limit("second_to", "of a curve: the other end", "required for a curve"),
    };
}

}  // namespace

const FieldTable& continue_fields() {
    static const FieldTable table = grouped("continue", continue_rows());
    return table;
}

}  // namespace vines::api
