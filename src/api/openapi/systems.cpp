// `parameters`, the resolved system of a request, and `provenance`.
#include "api/openapi/parts.hpp"

namespace vines::api::document {

namespace {

Keys reduced_keys() {
    return {
        {"epsilon", number(), "mass ratio m2/m1"},
        {"lambda", number(), "damping c1/(m2 omega0)"},
        {"G", number(), "amplitude of the base over epsilon, m"},
        {"Omega", number(), "forcing frequency over omega0"},
        {"R_plus", number(), "restitution coefficient of the wall at x - y = b"},
        {"R_minus", number(), "restitution coefficient of the wall at x - y = -b"},
        {"b", number(), "clearance: half-width of the cavity, m"},
        {"damping", enum_schema<Damping>(), "whether zeta is epsilon lambda/2 or epsilon lambda"},
        {"origin", map_of(text()), "source of each value"}};
}

Keys si_keys() {
    return {
        {"m1", number(), "mass of the linear oscillator, kg"},
        {"c1", number(), "damping of the oscillator, N s/m"},
        {"k1", number(), "stiffness of the oscillator, N/m"},
        {"m2", number(), "mass of the ball, kg"},
        {"F", number(), "amplitude of the base, m"},
        {"f", number(), "forcing frequency, Hz"}};
}

Key si_system(const Keys& keys) {
    return optional(
        {"si", object_of(keys), "the same system in SI, if the request or the preset is in SI"});
}

Key derived() {
    return {
        "derived",
        object_of(
            {{"zeta", number(), "damping ratio of the motion"},
             {"omega_d", or_null(number()), "sqrt(1 - zeta^2); null if zeta >= 1"},
             {"A", number(), "amplitude of the forcing over epsilon, m"},
             {"phi", number(), "phase of the forcing at tau = 0, rad"},
             {"cycle", number(), "length of a forcing cycle"},
             optional({"omega0", number(), "natural frequency in rad/s, for a system in SI"}),
             optional({"f0", number(), "natural frequency in Hz, for a system in SI"}),
             optional(
                 {"damping_ratio", number(),
                  "c1/(2 m1 omega0), for a system in SI; does not depend on `damping`"}),
             optional({"mass_ratio", number(), "m2/m1, for a system in SI"}),
             optional({"cycle_s", number(), "cycle in s, for a system in SI"})}),
        "values derived from these"};
}

Json simulation_parameters() {
    const Keys start_in_si = {
        {"x_velocity0", number(), "x_dot0 in m/s"}, {"y_velocity0", number(), "y_dot0 in m/s"}};
    return with_si(object_of(
        reduced_keys() +
        Keys{
            si_system(si_keys() + start_in_si),
            {"x0", number(), "displacement of the oscillator at tau = 0, m"},
            {"x_dot0", number(), "velocity of the oscillator at tau = 0, m per unit of tau"},
            {"y0", number(), "displacement of the ball at tau = 0, m"},
            {"y_dot0", number(), "velocity of the ball at tau = 0, m per unit of tau"},
            {"tau_end", number(), "requested length of the run"},
            {"cycles", number(), "requested length of the run in forcing cycles"},
            {"window", interval(), "requested window"},
            {"samples_per_cycle", number(), "samples of the series per forcing cycle"},
            {"section_phase", number(), "phase of the stroboscopic section, rad"},
            {"max_points", whole(), "as requested, or as reduced by a limit of the server"},
            {"max_impacts", whole(), "as requested"},
            derived()}));
}

Json provenance() {
    return object_of(
        {{"route", text(), "route of the request"},
         {"commit", text(), "commit of the program; empty if unknown"},
         {"answer_limit", or_null(whole()),
          "size in bytes to which the response was thinned, with a warning; null if it was not"},
         {"request", map_of(Json::object()),
          "fields of the request, sorted, without a record or a list of impacts"},
         optional(
             {"record_sha256", text(),
              "for an identification: hash of the file or JSON that was sent"}),
         {"sha256", or_null(text()),
          "hash of the response's text up to the comma before its last member provenance, followed "
          "by }; null in CBOR and npz"}});
}

}  // namespace

void add_systems(Json& schemas) {
    schemas["System"] = object_of(reduced_keys() + Keys{si_system(si_keys()), derived()});
    schemas["SimulationParameters"] = simulation_parameters();
    schemas["Provenance"] = provenance();
}

Keys answer_keys(const std::string& parameters) {
    return {
        {"version", text(), "version of the program"},
        {"parameters", reference(parameters), "all parameters, resolved"},
        {"warnings", list_of(text()), "sentences"}};
}

Keys sealed_keys(const std::string& parameters) {
    return answer_keys(parameters) + Keys{
                                         {"provenance", reference("Provenance"),
                                          "request and program that produced the response"}};
}

}  // namespace vines::api::document
