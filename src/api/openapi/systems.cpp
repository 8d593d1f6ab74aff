// `parameters`: the system that a request came to.
#include "api/openapi/systems.hpp"

#include "api/openapi/schemas.hpp"
#include "api/openapi/twins.hpp"
#include "api/openapi/words.hpp"

namespace vines::api::document {

namespace {

Keys reduced_keys() {
    return {
        {"epsilon", number(), "mass ratio m2/m1"},
        {"lambda", number(), "damping c1/(m2 omega0)"},
        {"G", number(), "amplitude of the base over epsilon, m"},
        {"Omega", number(), "forcing frequency over omega0"},
        {"R_plus", number(), "restitution coefficient of the wall where x - y = b"},
        {"R_minus", number(), "that of the wall where x - y = -b"},
        {"b", number(), "half-width of the cavity, m"},
        {"damping", word_of_any<Damping>(), "whether zeta is epsilon lambda/2 or epsilon lambda"},
        {"origin", map_of(text()), "for each value, where it comes from"}};
}

Keys si_keys() {
    return {
        {"m1", number(), "mass of the linear oscillator, kg"},
        {"c1", number(), "its damping, N s/m"},
        {"k1", number(), "its stiffness, N/m"},
        {"m2", number(), "mass of the absorber, kg"},
        {"F", number(), "amplitude of the base, m"},
        {"f", number(), "forcing frequency, Hz"}};
}

Key si_system(const Keys& keys) {
    return optional(
        {"si", object_of(keys), "the same system in SI, for a request or preset in SI"});
}

Key derived() {
    return {
        "derived",
        object_of(
            {{"zeta", number(), "damping ratio of the motion"},
             {"omega_d", or_null(number()), "sqrt(1 - zeta^2); null from zeta = 1 on"},
             {"A", number(), "amplitude of the forcing over epsilon, m"},
             {"phi", number(), "its phase at tau = 0, rad"},
             {"cycle", number(), "length of a forcing cycle"},
             optional({"omega0", number(), "of a system in SI: rad/s"}),
             optional({"f0", number(), "of a system in SI: Hz"}),
             optional(
                 {"damping_ratio", number(),
                  "of a system in SI: c1/(2 m1 omega0), whatever `damping` makes of it"}),
             optional({"mass_ratio", number(), "of a system in SI: m2/m1"}),
             optional({"cycle_s", number(), "of a system in SI: cycle in s"})}),
        "what follows from these"};
}

Json simulation_parameters() {
    const Keys start_in_si = {
        {"x_velocity0", number(), "x_dot0 in m/s"}, {"y_velocity0", number(), "y_dot0 in m/s"}};
    return with_si(object_of(
        reduced_keys() +
        Keys{
            si_system(si_keys() + start_in_si),
            {"x0", number(), "displacement of the oscillator at tau = 0, m"},
            {"x_dot0", number(), "its velocity, m per unit of tau"},
            {"y0", number(), "displacement of the free mass, m"},
            {"y_dot0", number(), "its velocity, m per unit of tau"},
            {"tau_end", number(), "how long it was to run"},
            {"cycles", number(), "the same in forcing cycles"},
            {"window", interval(), "as asked for"},
            {"samples_per_cycle", number(), "samples of the series per forcing cycle"},
            {"section_phase", number(), "of the stroboscopic section, rad"},
            {"max_points", whole(), "as asked for, or what a server's limit left of it"},
            {"max_impacts", whole(), "as asked for"},
            derived()}));
}

Json provenance() {
    return object_of(
        {{"route", text(), "that answered"},
         {"commit", text(), "of the program; empty where that is not known"},
         {"answer_limit", or_null(whole()), "bytes to which the answer was thinned, if it was"},
         {"request", map_of(Json::object()), "its fields, names in order; without a record"},
         optional({"record_sha256", text(), "of the file, or the JSON, that was sent"}),
         {"sha256", or_null(text()), "of the answer's text without provenance; null but in JSON"}});
}

}  // namespace

void add_systems(Json& schemas) {
    schemas["System"] = object_of(reduced_keys() + Keys{si_system(si_keys()), derived()});
    schemas["SimulationParameters"] = simulation_parameters();
    schemas["Provenance"] = provenance();
}

Keys answer_keys(const std::string& parameters) {
    return {
        {"version", text(), "of the program"},
        {"parameters", reference(parameters), "all of them, resolved"},
        {"warnings", list_of(text()), "sentences"}};
}

Keys sealed_keys(const std::string& parameters) {
    return answer_keys(parameters) +
           Keys{{"provenance", reference("Provenance"), "what it was made of"}};
}

}  // namespace vines::api::document
