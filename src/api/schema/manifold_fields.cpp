// The table of /v1/manifold: the system's rows of /v1/simulate, and the extent of the branches.
#include <algorithm>
#include <iterator>

#include "api/schema/tables.hpp"

namespace vines::api {

namespace {

FieldTable make_manifold_fields() {
    FieldTable table;
    std::copy_if(
        simulate_fields().begin(), simulate_fields().end(), std::back_inserter(table),
        is_of_system);
    table.push_back(
        {.name = "V_max",
         .group = "output",
         .unit = "m per unit of tau",
         .symbol = "V",
         .description = "largest speed of the free mass on the branch beyond the symmetry "
                        "breaking, which ends with the motion in any case",
         .fallback_note = "twice the speed of the symmetry breaking",
         .range = Range{1e-12, 1e6}});
    table.push_back(
        {.name = "points",
         .type = FieldType::integer,
         .group = "output",
         .description = "points of each branch",
         .fallback = 200,
         .range = Range{2, 100000}});
    return table;
}

}  // namespace

const FieldTable& manifold_fields() {
    static const FieldTable table = make_manifold_fields();
    return table;
}

}  // namespace vines::api
