// The answer of /v1/identify.
#include "api/openapi/exponents.hpp"
#include "api/openapi/schemas.hpp"
#include "api/openapi/systems.hpp"
#include "api/openapi/twins.hpp"
#include "api/openapi/words.hpp"
#include "api/schema/tables.hpp"

namespace vines::api::document {

namespace {

Json signal() {
    const Json forcing = object_of(
        {{"f", number(), "by that channel, Hz"},
         {"F", number(), "amplitude of the base, m, or of one that would act as the force does"},
         {"phase", number(),
          "by which the oscillator's motion shows the forcing later than the channel, rad"}});
    return object_of(
        {{"samples", whole(), "number of them"},
         {"sampling_rate", number(), "Hz"},
         {"noise_displacement", or_null(number()), "standard deviation of what the fit leaves, m"},
         {"noise_acceleration", or_null(number()),
          "standard deviation of what the fit leaves, m/s^2"},
         {"misfit",
          object_of(
              {{"displacement", or_null(number()), "1 if all is explained"},
               {"acceleration", or_null(number()), "1 if all is explained"}}),
          "what is left over what of it is noise, of any colour, and no missed motion"},
         {"pulse_s", number(),
          "length of the pulse by which an impact shows in the acceleration; 0 where too few are "
          "seen"},
         {"pulse_delay_s", or_null(number()),
          "from the impact to its pulse's highest point; null where too few are seen"},
         {"pulse_spoils_s", interval(),
          "from when to when, about an impact, the acceleration shows a pulse and its ringing"},
         {"pulses_unseen", whole(), "impacts that no pulse shows, but a kink of the displacement"},
         {"G", number(), "of the forcing, m"},
         {"force_sin", number(),
          "the forcing is force_sin sin(Omega tau) + force_cos cos(Omega tau), m"},
         {"force_cos", number(), "of the forcing, m"},
         {"forcing", or_null(forcing), "null without a channel of the base or of a force"}});
}

/// What can be fixed is what is fitted.
Json fitted() {
    const Json value = object_of(
        {{"value", or_null(number()), "in SI"},
         {"standard_error", or_null(number()), "null of what is fixed"},
         {"fixed", flag(), "taken as given"}});
    Keys keys;
    for (const std::string& name : find(identify_fields(), "fixed")->choices)
        keys.push_back({name, value, ""});
    return object_of(keys);
}

Keys impact_keys() {
    const Json some = list_of(or_null(number()));
    return {
        {"x", some, "displacement, m"},
        {"x_dot_before", some, "from the fit"},
        {"x_dot_after", some, "from the fit"},
        {"x_ddot_before", some, "from the fit"},
        {"y_dot_before", some, "from the flights, eq. (43)"},
        {"y_dot_after", some, "from the flights, eq. (43)"},
        {"R", some, "from eq. (4); null at the first and the last"},
        {"momentum_error", some, "of x' + epsilon y', over the median jump of x'"},
        {"status", list_of(text()),
         "ok, R is not known, hidden, or why it is left out of the exponents"}};
}

Json identified_impacts() {
    return object_of(
        Keys{{"tau", numbers(), "moment"}, {"side", list_of(side()), "wall"}} + impact_keys());
}

Json restitution() {
    const Json wall = object_of(
        {{"R", or_null(number()), "fitted; of a list of impacts their median"},
         {"standard_error", or_null(number()), "of that"},
         {"impacts", whole(), "how many"}});
    return object_of({{"plus", wall, "of the wall at +b"}, {"minus", wall, "of the wall at -b"}});
}

Json fitted_motion() {
    return object_of(
        {{"tau", numbers(), "moment"},
         {"x", numbers(), "m"},
         {"x_dot", numbers(), "velocity of the oscillator"},
         {"x_ddot", numbers(), "without the pulses by which impacts show in an acceleration"}});
}

Json direct() {
    return object_of(
        {{"impacts", object_of(impact_keys()), "those of impacts, in the same order"},
         {"restitution", reference("Restitution"), "of each wall"},
         {"lambda", four_exponents(),
          "by qr, without the impacts whose status here speaks against them"},
         optional(
             {"exponents", reference("MeasuredExponents"),
              "if include has direct_exponents: of the same impacts, whatever their status "
              "here"})});
}

Json forward_run() {
    const Json impacts = object_of(
        {{"tau", numbers(), "moment"},
         {"side", list_of(side()), "wall"},
         {"x", numbers(), "displacement, m"},
         {"x_dot_after", numbers(), "velocity of the oscillator"}});
    return object_of(
        {{"start", number(), "tau from which it runs"},
         {"impacts", impacts, "of that run"},
         {"lambda", four_exponents(), "by qr"}});
}

Key of_record(const std::string& name, const Json& schema, const std::string& description) {
    return optional({name, schema, "of a record: " + description});
}

Keys record_keys() {
    return {
        of_record("signal", reference("Signal"), "noise, misfit, pulse, forcing"),
        of_record(
            "fitted", reference("Fitted"),
            "what it says of its sensors, of the forcing's frequency and of the oscillator"),
        of_record(
            "motion", reference("FittedMotion"),
            "if include has it, the fitted motion at its samples"),
        of_record(
            "direct", or_null(reference("DirectEstimate")),
            "the paper's estimate beside it, where it has both sensors"),
        of_record(
            "forward", or_null(reference("ForwardRun")),
            "a run of the identified system from the first known state")};
}

Json identification() {
    return object_of(
        sealed_keys("System") + record_keys() +
        Keys{
            {"impacts", reference("IdentifiedImpacts"), "every impact, with a status"},
            {"sticking", reference("Sticking"), "every stuck phase"},
            {"restitution", reference("Restitution"), "of each wall"},
            {"b_fitted",
             object_of(
                 {{"b", or_null(number()), "m; null where the momentum fits none"},
                  {"standard_error", or_null(number()),
                   "m; null where the mass took no part in the fit"}}),
             "the b that the momentum fits best"},
            {"exponents", reference("MeasuredExponents"), "of the sequence of impacts"},
            {"slope",
             object_of(
                 {{"lambda1", or_null(number()), "growth of lambda1(tau) tau in the long run"},
                  {"low", or_null(number()), "of its 90 % interval"},
                  {"high", or_null(number()), "of its 90 % interval"}}),
             "how lambda1(tau) tau grows"},
            {"verdict", word_of_any<Verdict>(),
             "chaotic, regular, not_decided; null where the impacts die out, for no forcing keeps "
             "them up"},
            {"verdict_reason", text(), "a sentence"}});
}

}  // namespace

void add_identification(Json& schemas) {
    schemas["Identification"] = identification();
    schemas["Signal"] = signal();
    schemas["Fitted"] = fitted();
    schemas["IdentifiedImpacts"] = with_si(identified_impacts());
    schemas["Restitution"] = restitution();
    schemas["FittedMotion"] = with_si(fitted_motion());
    schemas["DirectEstimate"] = with_si(direct());
    schemas["ForwardRun"] = with_si(forward_run());
}

}  // namespace vines::api::document
