// The part `manifold`, and the answer of /v1/manifold.
#include "api/openapi/schemas.hpp"
#include "api/openapi/systems.hpp"
#include "api/openapi/twins.hpp"
#include "api/openapi/words.hpp"

namespace vines::api::document {

namespace {

Json manifold_point() {
    return object_of(
        {{"C", number(), "amplitude of the oscillator, m"},
         {"V", number(), "speed of the free mass, m per unit of tau"}});
}

Keys branch_keys() {
    return {
        {"C", numbers(), "amplitudes of the oscillator, m"},
        {"V", numbers(), "speeds of the free mass, m per unit of tau"}};
}

Keys manifold_keys() {
    return {
        {"R", number(), "of both walls"},
        {"Omega", number(), "of the system"},
        {"b", number(), "of the system, m"},
        {"fold", manifold_point(), "where C is smallest"},
        {"activation_amplitude", number(), "that C: below it the absorber cannot be activated, m"},
        {"symmetry_breaking", or_null(manifold_point()),
         "where the impacts become asymmetric; null where the motion ends before"},
        {"second_contact", manifold_point(),
         "where the mass meets the wall it comes from a second time: the motion ends"},
        {"stable_ends_by", one_of({"symmetry_breaking", "second_contact"}), "which comes first"},
        {"stable", object_of(branch_keys()), "from the fold to the end of stability"},
        {"unstable", object_of(branch_keys()), "below the fold"},
        {"asymmetric", object_of(branch_keys()), "beyond the symmetry breaking"},
        {"free_amplitude", or_null(number()),
         "steady amplitude without the absorber, m; null undamped at resonance"},
        {"b_at_free_amplitude", or_null(number()),
         "puts the fold there, m: the limit of activation, no advice"}};
}

Json recommendation() {
    return object_of(
        {{"b", number(), "half-width of the cavity, m"},
         {"fold_share", number(), "the fold's amplitude over free_amplitude"},
         {"x_rms_ratio", number(), "rms of x over that without the absorber, from that start"},
         {"x_max", number(), "largest modulus of x, m, from that start"},
         {"regime", regime_name(), "of the motion from that start"},
         {"start", text(), "of the default set, from which the motion is the worst"}});
}

/// Of a run with walls that differ there are the half cycles alone.
Keys run_keys() {
    Keys keys;
    for (const Key& key : manifold_keys()) keys.push_back(optional(key));
    const Keys points = {{"tau", numbers(), "end of each half cycle"}};
    keys.push_back(
        {"points", object_of(points + branch_keys()),
         "the run: largest modulus of x and mean modulus of y' in each half cycle"});
    return keys;
}

}  // namespace

void add_manifolds(Json& schemas) {
    const Keys recommended = {
        {"recommended", or_null(recommendation()),
         "the b whose worst motion has the smallest rms of x; null where none of those tried "
         "reduces the motion, or where the time limit was over before"}};
    const Key manifold = {
        "manifold", reference("SlowManifold"), "its fold, branches and ends, and a recommended b"};
    schemas["SlowManifold"] = with_si(object_of(manifold_keys() + recommended));
    schemas["RunManifold"] = with_si(object_of(run_keys()));
    schemas["Manifold"] = object_of(sealed_keys("System") + Keys{manifold});
}

}  // namespace vines::api::document
