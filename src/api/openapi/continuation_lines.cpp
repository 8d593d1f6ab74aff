// The lines of the response of /v1/continue.
#include "api/continuation.hpp"
#include "api/openapi/parts.hpp"

namespace vines::api::document {

namespace {

Key branch_key() { return {"branch", whole(), "number of the branch, from 0"}; }

Keys branch_orbit_keys() {
    return swept_keys(number(), "value of a continued parameter", is_of_system) +
           values_of(properties::branch_point) +
           Keys{
               {"multipliers", multipliers_schema(), "Floquet multipliers of a period, descending"},
               {"state", object_of(values_of(properties::start)),
                "state of the orbit at a whole cycle, as the start of a simulation"}};
}

Json special_schema() {
    return line_of(
        "special",
        Keys{
            {"branch", or_null(whole()), "number of the branch; null if there is no first orbit"},
            {"kind",
             one_of({"fold", "flip", "symmetry_breaking", "torus", "grazing", "stick", "end"}),
             "kind of the point"}} +
            optional(branch_orbit_keys()) +
            Keys{
                optional(
                    {"reason",
                     one_of(
                         {"range", "grazing", "last_impact", "stick", "parent", "closed", "points",
                          "impacts", "not_decided", "no_orbit", "no_impacts", "no_such_point"}),
                     "of an end: why the branch ends"}),
                optional({"detail", text(), "the same as a sentence"}),
                optional(
                    {"impacts_beyond", or_null(whole()),
                     "of a grazing contact: impacts per period with which the branch continues; "
                     "null "
                     "if it does not"}),
                optional(
                    {"angle", number(), "of a torus: angle of the multiplier of modulus 1, rad"})});
}

}  // namespace

Json multipliers_schema() {
    return object_of(
        {{"re", numbers(), "real parts"},
         {"im", numbers(), "imaginary parts"},
         {"modulus", numbers(), "moduli"}});
}

void add_continuation_lines(Json& schemas) {
    schemas["ContinueLine"] = by_type(
        {{"start", "ContinueStart"},
         {"branch", "ContinueBranch"},
         {"point", "ContinuePoint"},
         {"special", "ContinueSpecial"},
         {"progress", "ContinueProgress"},
         {"done", "ContinueDone"},
         {"error", "SweepError"}});
    schemas["ContinueStart"] = object_of(
        answer_keys("System") + Keys{
                                    {"type", constant("start"), ""},
                                    {"commit", text(), "commit of the program; empty if unknown"},
                                    {"parameter", text(), "name of the continued parameter"},
                                    {"from", number(), "one end of its range"},
                                    {"to", number(), "the other end"},
                                    {"request", reference("ContinueRequest"), "the request"}});
    schemas["ContinueBranch"] = line_of(
        "branch",
        {branch_key(),
         {"from_branch", or_null(whole()), "branch on which it begins; null: at the first orbit"},
         {"begins_at", one_of({"start", "fold", "flip", "symmetry_breaking", "torus", "grazing"}),
          "kind of point there, or of the curve"},
         {"direction", one_of({"up", "down"}), "first change of the parameter"}});
    schemas["ContinuePoint"] = line_of("point", Keys{branch_key()} + branch_orbit_keys());
    schemas["ContinueSpecial"] = special_schema();
    schemas["ContinueProgress"] = line_of(
        "progress",
        {{"done", whole(), "points so far"}, {"per_second", number(), "points per second"}});
    schemas["ContinueDone"] = line_of(
        "done", {{"points", whole(), "number of points"},
                 {"specials", whole(), "number of special points, with the ends"},
                 {"branches", whole(), "number of branches"}});
}

}  // namespace vines::api::document
