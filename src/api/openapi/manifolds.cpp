// The part `manifold` of a simulation, and the response of /v1/manifold.
#include "api/openapi/parts.hpp"
#include "api/properties.hpp"

namespace vines::api::document {

namespace {

Json manifold_point() { return object_of(values_of(properties::manifold_point)); }

Keys manifold_keys() {
    return {
        {"R", number(), "restitution coefficient of both walls"},
        {"Omega", number(), "forcing frequency over omega0"},
        {"b", number(), "clearance, m"},
        {"fold", manifold_point(), "the point with the smallest C"},
        {"activation_amplitude", number(),
         "C at the fold, m: below it the absorber cannot be activated"},
        {"symmetry_breaking", or_null(manifold_point()),
         "the point at which the impacts become asymmetric; null if the second contact comes "
         "first"},
        {"second_contact", manifold_point(),
         "the point at which the ball meets the same wall a second time: this motion ends there"},
        {"stable_ends_by", one_of({"symmetry_breaking", "second_contact"}),
         "the point that comes first"},
        {"stable", table_of(branch_columns), "branch from the fold to the end of stability"},
        {"unstable", table_of(branch_columns), "branch below the fold"},
        {"asymmetric", table_of(branch_columns), "branch beyond the symmetry breaking"},
        {"free_amplitude", or_null(number()),
         "steady amplitude without the absorber, m; null if undamped at resonance"},
        {"b_at_free_amplitude", or_null(number()),
         "the b that puts the fold at free_amplitude, m: the limit of activation, not a "
         "recommendation"}};
}

/// A run whose walls differ has the half cycles only.
Keys run_keys() {
    Keys keys = optional(manifold_keys());
    const Keys points = {column_of(quantity.tau.with("end of each half cycle"))};
    keys.push_back(
        {"points", object_of(points + columns_of(branch_columns)),
         "the run: maximum of |x| and mean of |y'| in each half cycle"});
    return keys;
}

}  // namespace

void add_manifolds(Json& schemas) {
    const Json recommendation = object_of(values_of(properties::recommendation));
    const Keys recommended = {
        {"recommended", or_null(recommendation),
         "the b whose worst motion at this F and f has the smallest rms of x; null if no b "
         "reduces the motion, or if the time limit ended the search"},
        {"robust", or_null(recommendation),
         "the b with the smallest tolerance_ratio; null if it is the recommended one or hardly "
         "better"}};
    const Key manifold = {
        "manifold", reference("SlowManifold"), "fold, branches, end points, and a recommended b"};
    schemas["SlowManifold"] = with_si(object_of(manifold_keys() + recommended));
    schemas["RunManifold"] = with_si(object_of(run_keys()));
    schemas["Manifold"] = object_of(sealed_keys("System") + Keys{manifold});
}

}  // namespace vines::api::document
