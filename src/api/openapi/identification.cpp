// The response of /v1/identify.
#include "api/openapi/parts.hpp"
#include "api/properties.hpp"

namespace vines::api::document {

namespace {

/// A key of the response to a record.
Keys of_record(const std::string& name, const Schema& schema, const std::string& description) {
    return {name + "?", schema, "for a record: " + description};
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
void add_identification(Json& schemas) {
    schemas["Identification"] = object_of(
        {sealed_keys("System"),
         of_record("signal", reference("Signal"), "noise, misfit, pulse, forcing"),
         of_record(
             "fitted", reference("Fitted"),
             "fitted properties of the sensors, of the forcing and of the oscillator"),
         of_record(
             "laws", or_null(reference("BallLaws")),
             "with fit, the fitted laws of the ball; null if they do not settle or b is withheld"),
         of_record(
             "motion", reference("FittedMotion"),
             "if include has motion, the fitted motion at the samples"),
         of_record(
             "direct", or_null(reference("DirectEstimate")),
             "estimate by the paper's method, with velocities from differences of the "
             "displacement, for comparison; null without both sensors"),
         of_record(
             "forward", or_null(reference("ForwardRun")),
             "a run of the identified system from the first known state"),
         {"impacts", reference("IdentifiedImpacts"), "every impact, with a status"},
         {"sticking", reference("Sticking"), "every sticking phase"},
         {"restitution", reference("Restitution"), "restitution coefficient of each wall"},
         {"b_fitted", object_of(values_of(properties::fitted_b)),
          "the b that conserves momentum best"},
         {"exponents", reference("MeasuredExponents"),
          "Lyapunov exponents of the sequence of impacts"},
         {"slope", object_of(values_of(properties::slope)), "growth of lambda1(tau) tau"},
         {"verdict", verdict,
          "chaotic, regular, not_decided; null without forcing, or if the impacts die out"},
         {"verdict_reason", word, "reason for the verdict, a sentence"}});
    const Json forcing = object_of(
        {{"f", number, "forcing frequency in that channel, Hz"},
         {"F", number, "amplitude of the base, m; for a force, that of the equivalent base motion"},
         {"phase", number,
          "phase lag of the forcing in the oscillator's motion after that in the channel, rad"},
         {"load", one_of({"measured", "sine"}),
          "measured: variations and harmonics in the channel are part of the forcing; sine: it "
          "shows none"}});
    schemas["Signal"] = object_of(
        {{"samples", whole, "number of samples"},
         {"sampling_rate", number, "sampling rate, Hz"},
         {"noise_displacement", number_or_null, "standard deviation of the residuals, m"},
         {"noise_acceleration", number_or_null, "standard deviation of the residuals, m/s^2"},
         {"misfit",
          object_of(
              {{"displacement", number_or_null, "1 if the model explains all motion"},
               {"acceleration", number_or_null, "1 if the model explains all motion"}}),
          "residuals over their noise part: the noise can have any colour, the remainder is "
          "motion that the model does not explain"},
         {"pulse_s", number,
          "length of the pulse of an impact in the acceleration, of a half sine of the same width "
          "at half height; 0 if too few pulses are visible"},
         {"pulse_delay_s", number_or_null,
          "time from an impact to the peak of its pulse; null if too few pulses are visible"},
         {"pulse_spoils_s", interval,
          "interval around an impact in which pulse and ringing spoil the acceleration"},
         {"pulses_unseen", whole,
          "impacts without a visible pulse, found by a kink of the displacement"},
         {"G", number, "amplitude of the base over epsilon, m"},
         {"force_sin", number,
          "the forcing is force_sin sin(Omega tau) + force_cos cos(Omega tau), m"},
         {"force_cos", number, "see force_sin, m"},
         {"forcing", or_null(forcing),
          "forcing by the channel of the base or of a force; null without one"}});
    const Json value = object_of(
        {{"value", number_or_null, "in SI"},
         {"standard_error", number_or_null, "null if fixed"},
         {"fixed", flag, "true: the given value is used, not fitted"}});
    schemas["Fitted"] = object_of(
        {{"f", value, "frequency of the forcing, Hz"},
         {"displacement_offset", value,
          "offset of the displacement in the middle of the record, m"},
         {"displacement_drift", value, "drift of the displacement over the record, m"},
         {"displacement_gain", value,
          "measured displacement over that which follows from the acceleration"},
         {"displacement_delay_s", value, "delay of the displacement after the acceleration, s"},
         {"acceleration_offset", value,
          "offset of the acceleration in the middle of the record, m/s^2"},
         {"acceleration_drift", value, "drift of the acceleration over the record, m/s^2"},
         {"omega0", value, "natural frequency of the oscillator, rad/s; tau uses the given one"},
         {"zeta", value, "damping ratio of the oscillator"},
         {"b", value, "clearance, m"},
         {"R_plus", value, "restitution coefficient of the wall at +b"},
         {"R_minus", value, "restitution coefficient of the wall at -b"},
         {"F", value, "amplitude of the base, m"},
         {"phase", value, "the base moves by F sin(2 pi f t + phase), rad"}});
    schemas["BallLaws"] = object_of(
        {{"mu", value, "friction of the ball over its weight"},
         {"R_slope", value, "growth of R of both walls per m/s of |x' - y'|"},
         {"R_speed", number, "speed at which R_plus and R_minus apply, the mean one, m/s"},
         {"chi_square_decrease", number,
          "by which the fitted laws decrease the sum of squared residuals over their variances; "
          "about the number of laws if the given ones hold"}});
    schemas["IdentifiedImpacts"] =
        object_of({columns_of(identified_wall_columns), columns_of(identified_columns)});
    const Json wall = object_of(values_of(properties::restitution));
    schemas["Restitution"] =
        object_of({{"plus", wall, "the wall at +b"}, {"minus", wall, "the wall at -b"}});
    schemas["FittedMotion"] =
        object_of({column_of(quantity.tau), columns_of(fitted_motion_columns)});
    schemas["DirectEstimate"] = object_of(
        {{"impacts", table_of(identified_columns), "the same impacts, in the same order"},
         {"restitution", reference("Restitution"), "restitution coefficients"},
         {"lambda", exponents,
          "four exponents by qr, without the impacts that status excludes here"},
         {"exponents?", reference("MeasuredExponents"),
          "if include has direct_exponents: exponents from the impacts that the fit uses, "
          "whatever their status here"}});
    schemas["ForwardRun"] = object_of(
        {{"start", number, "tau at the start of the run"},
         {"impacts", table_of(forward_impact_columns), "impacts of the run"},
         {"lambda", exponents, "four exponents by qr"}});
}

}  // namespace vines::api::document
