// The table of /v1/continue.
#include "api/schema/tables.hpp"

namespace vines::api {

const FieldTable& continue_fields() {
    using enum FieldType;
    static const FieldTable table = grouped(
        "continue",
        {{"base",
          "fields of /v1/simulate: system, reduced or SI, start, preset; it also sets the "
          "parameter's value at which the continuation starts",
          object, any_value, Json::object()},
         // The reader of the request checks the name and lists the valid ones.
         {"parameter", "name of a numeric parameter of the system, dimensionless or SI", choice,
          any_value, nullptr, "required"},
         {"from", "one end of the parameter's range", number, any_number, nullptr, "required"},
         {"to", "the other end", number, any_number, nullptr, "required"},
         {"orbit",
          "the first orbit. settled: the one on which the base's motion settles, which is "
          "stable; stated: the one next to the base's start, which can be unstable",
          choice, Choices{"settled", "stated"}, "settled"},
         {"period_cycles", "period of the stated orbit in forcing cycles, or a multiple of it",
          integer, Range{1, 64}, 1, "", dimensionless},
         {"transient_cycles", "cycles before the search for the settled orbit", integer,
          Range{0, 1e6}, 200, "", dimensionless},
         {"cycles", "further cycles in which the motion must settle", integer, Range{1, 1e6}, 1000,
          "", dimensionless},
         {"resolution",
          "largest step of the parameter as a fraction of its range; steps are shorter where "
          "the "
          "orbit changes fast",
          number, Range{1e-5, 1}, 0.01, "", dimensionless},
         {"points", "largest number of points of a branch", integer, Range{2, 100000}, 2000, "",
          dimensionless},
         {"switch",
          "depth of branch switching: 1 also follows the branches that begin at flips and "
          "symmetry breakings, 2 those that begin on these, and so on; true is 2",
          integer, Range{0, 6}, 0, "", dimensionless},
         {"curve",
          "follow the special points of this kind, instead of the branch, in two parameters",
          choice, Choices{"fold", "flip", "symmetry_breaking", "torus", "grazing", "stick"},
          nullptr, "none"},
         {"second", "of a curve: name of the second parameter", choice, any_value, nullptr,
          "required for a curve"},
         {"second_from", "of a curve: one end of its range", number, any_number, nullptr,
          "required for a curve"},
         {"second_to", "of a curve: the other end", number, any_number, nullptr,
          "required for a curve"}});
    return table;
}

}  // namespace vines::api
