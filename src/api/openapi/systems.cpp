// `parameters`, the resolved system of a request, and `provenance`.
#include "api/openapi/parts.hpp"
#include "api/properties.hpp"

namespace vines::api::document {

namespace {

Keys system_keys() {
    const Json load = object_of(
        {{"kind", one_of({"record", "half_sine", "chirp", "noise", "harmonics"}), "of the load"},
         {"length", or_null(number()), "in tau; null for harmonics"},
         {"sampling_error", number(),
          "bound of the difference between the motion of the base and its formula, m; 0 if they "
          "agree to rounding"}});
    return {
        values_of(properties::reduced),
        {"forcing?", load, "load, if it replaces F and f"},
        {"restitution_plus?", reference("RestitutionTable"),
         "R of the wall at x - y = b as a function of the speed, if it is not constant"},
        {"restitution_minus?", reference("RestitutionTable"), "the same at x - y = -b"},
        {"origin", map_of(text()), "source of each value"}};
}

Keys si_system(const Keys& keys) {
    return {"si?", object_of(keys), "the same system in SI, if the request or the preset is in SI"};
}

Keys derived() {
    const Keys keys = {values_of(properties::derived), optional(values_of(properties::derived_si))};
    return {"derived", object_of(keys), "values derived from these"};
}

}  // namespace

void add_systems(Json& schemas) {
    schemas["RestitutionTable"] = object_of(
        {{"speed", numbers(), "|x' - y'| before the impact, m per unit of tau"},
         {"R", numbers(), "restitution coefficient at each speed, linear in between"}});
    schemas["System"] = object_of({system_keys(), si_system(values_of(properties::si)), derived()});
    const Keys start_in_si = {
        {"x_velocity0", number(), "x_dot0 in m/s"}, {"y_velocity0", number(), "y_dot0 in m/s"}};
    schemas["SimulationParameters"] = object_of(
        {system_keys(),
         si_system({values_of(properties::si), start_in_si}),
         {"x0", number(), "displacement of the oscillator at tau = 0, m"},
         {"x_dot0", number(), "velocity of the oscillator at tau = 0, m per unit of tau"},
         {"y0", number(), "displacement of the ball at tau = 0, m"},
         {"y_dot0", number(), "velocity of the ball at tau = 0, m per unit of tau"},
         {"tau_end", number(), "requested length of the run"},
         {"cycles", number(), "requested length of the run in forcing cycles"},
         {"window", interval(), "requested window"},
         {"samples_per_cycle", number(), "samples of the series per forcing cycle"},
         {"settle_cycles", number(), "as requested"},
         {"section_phase", number(), "phase of the stroboscopic section, rad"},
         {"max_points", whole(), "as requested, or as reduced by a limit of the server"},
         {"max_impacts", whole(), "as requested"},
         derived()});
    schemas["Provenance"] = object_of(
        {{"route", text(), "route of the request"},
         {"commit", text(), "commit of the program; empty if unknown"},
         {"answer_limit", or_null(whole()),
          "size in bytes to which the response was thinned, with a warning; null if it was not"},
         {"request", map_of(Json::object()),
          "fields of the request, sorted, without a record or a list of impacts"},
         {"record_sha256?", text(),
          "for an identification: hash of the file or JSON that was sent"},
         {"sha256", text(), "hash of the response's content without provenance"}});
}

Keys answer_keys(const std::string& parameters) {
    return {
        {"version", text(), "version of the program"},
        {"parameters", reference(parameters), "all parameters, resolved"},
        {"warnings", list_of(text()), "sentences"}};
}

Keys sealed_keys(const std::string& parameters) {
    return {
        answer_keys(parameters),
        {"provenance", reference("Provenance"), "request and program that produced the response"}};
}

}  // namespace vines::api::document
