// The response of /v1/simulate: one schema for each part.
#include "api/openapi/parts.hpp"

namespace vines::api::document {

Keys impact_section_keys() {
    return {
        {"side", list_of(side()), "sign of x - y"},
        {"phase", numbers(), "phase of the forcing, Omega tau + phi, in [0, 2 pi)"},
        {"x", numbers(), "displacement of the oscillator, m"},
        {"x_dot_after", numbers(), "velocity of the oscillator"},
        {"y_dot_after", numbers(), "velocity of the ball"},
        {"time_difference", list_of(or_null(number())),
         "time since the previous impact; null for the first impact of the run"}};
}

Keys stroboscopic_keys() {
    return {
        {"x", numbers(), "displacement of the oscillator, m"},
        {"x_dot", numbers(), "velocity of the oscillator"},
        {"y", numbers(), "displacement of the ball, m"},
        {"y_dot", numbers(), "velocity of the ball"}};
}

namespace {

Key time_key(const std::string& description) { return {"tau", numbers(), description}; }

Json run_status() {
    return with_si(object_of(
        {{"reason", one_of({"tau_end", "max_impacts", "deadline"}),
          "deadline: the time limit of the server for one request"},
         {"tau", number(), "time at which the run ended"},
         {"message", text(), "a sentence"}}));
}

Json series() {
    return object_of(
        Keys{time_key("equal steps, then the end of the run")} + stroboscopic_keys() +
        Keys{{"x_ddot", numbers(), "acceleration of the oscillator between impacts"}});
}

Json impacts() {
    return object_of(
        {time_key("time"),
         {"side", list_of(side()), "sign of x - y"},
         {"phase", numbers(), "phase of the forcing, Omega tau + phi, in [0, 2 pi)"},
         {"x", numbers(), "displacement of the oscillator, m"},
         {"x_dot_before", numbers(), "velocity of the oscillator"},
         {"x_dot_after", numbers(), "velocity of the oscillator"},
         {"y_dot_before", numbers(), "velocity of the ball"},
         {"y_dot_after", numbers(), "velocity of the ball"},
         {"x_ddot_before", numbers(), "acceleration of the oscillator"},
         {"relative_speed", numbers(), "|x' - y'| before the impact"},
         {"impulse", numbers(), "impulse on the ball per m1, epsilon (y'+ - y'-)"},
         {"relative_speed_ratio", list_of(or_null(number())),
          "relative_speed over its median; 0 for a grazing contact"},
         {"grazing", list_of(flag()), "true for a nearly tangent impact"}});
}

Json sticking() {
    return object_of(
        {{"side", list_of(side()), "side of the wall"},
         {"tau_start", numbers(), "start: the end of the chatter"},
         {"tau_end", numbers(), "release, or the end of the run"},
         {"impacts", list_of(whole()), "impacts of the chatter, all on this side"}});
}

Json touches() { return object_of({time_key("time"), {"side", list_of(side()), "sign of x - y"}}); }

Json eigenvalues() {
    const Json moduli = list_of(list_of(number(), 4));
    return object_of(
        {time_key("time"),
         {"J", moduli, "transfer matrix of the flight before the impact: four moduli, descending"},
         {"M", moduli, "transfer matrix of the impact"},
         {"T", list_of(four_exponents()),
          "T = M J; null if rounding leaves no accurate digit, at the end of a chatter"},
         {"M_condition", list_of(or_null(number())),
          "condition number of M in the Frobenius norm; null if R = 0"}});
}

Json matrices() {
    const Json by_rows = list_of(list_of(list_of(number(), 4), 4));
    return object_of(
        {time_key("time"),
         {"order", list_of(one_of({"x_dot", "x", "y_dot", "y"}), 4), "order of rows and columns"},
         {"J", by_rows, "transfer matrix of the flight before the impact, by rows"},
         {"M", by_rows, "transfer matrix of the impact, by rows"},
         {"T", by_rows, "T = M J, by rows"}});
}

Json section() {
    return object_of(
        {{"impact",
          object_of(Keys{time_key("time of each impact in the window")} + impact_section_keys()),
          "Poincare section at impact"},
         {"stroboscopic",
          object_of(
              Keys{time_key("one time per cycle, section_phase after its start")} +
              stroboscopic_keys()),
          "stroboscopic section, once per cycle"}});
}

Keys decay_keys() {
    return {
        {"tau_half", or_null(number()),
         "time at which half of the energy is left; null if not reached"},
        {"tau_tenth", or_null(number()), "time at which a tenth is left; null if not reached"}};
}

Json energy() {
    return with_joules(object_of(
        {{"window", interval(), "interval of the balance"},
         {"input", number(), "work of the forcing"},
         {"damper", number(), "energy dissipated by the damper, 2 zeta x'"},
         {"impacts", number(), "energy dissipated in impacts"},
         {"stored", number(), "stored energy at the end minus that at the start"},
         {"residual", number(), "error of the balance"},
         {"share_impacts", or_null(number()),
          "fraction of the dissipated energy; null if none is dissipated"},
         {"at_start", number(), "stored energy at the start"},
         {"at_end", number(), "stored energy at the end"},
         {"rms", number(), "rms of x, m"},
         {"peak", number(), "maximum of |x|, m"},
         {"without_absorber",
          object_of(
              {{"rms", number(), "rms of x, m"},
               {"peak", number(), "maximum of |x|, m"},
               {"amplitude", or_null(number()),
                "steady amplitude, m; null if undamped at resonance"}}),
          "the same oscillator, start and window without the ball"},
         {"rms_ratio", or_null(number()), "rms with over rms without the absorber"},
         {"peak_ratio", or_null(number()), "peak with over peak without the absorber"},
         optional(
             {"decay",
              object_of(
                  decay_keys() +
                  Keys{{"without_absorber", object_of(decay_keys()), "the same without the ball"}}),
              "decay of the energy; only if G = 0"})}));
}

Json capture() {
    return object_of(
        {{"tau", or_null(number()),
          "time at which the orbit captured the run; null if the run ends before"},
         {"status", one_of({"captured", "on_its_way"}),
          "on_its_way: the run ends before its capture"},
         {"chaotic_before", or_null(flag()), "true after a chaotic transient; null if unknown"},
         {"exponents_before", object_of(final_keys()),
          "exponents of the run before the capture, by qr"},
         {"exponents_after", object_of(final_keys()),
          "exponents of the orbit, from its multipliers"}});
}

/// All are null unless the motion is periodic.
Keys orbit_keys() {
    const Json multipliers = object_of(
        {{"re", numbers(), "real part"},
         {"im", numbers(), "imaginary part"},
         {"modulus", numbers(), "modulus, descending"}});
    const Json orbit = object_of(
        {{"tau", number(), "a time on the orbit, during a flight"},
         {"x_dot", number(), "velocity of the oscillator at that time"},
         {"x", number(), "displacement of the oscillator at that time, m"},
         {"y_dot", number(), "velocity of the ball at that time"},
         {"y", number(), "displacement of the ball at that time, m"}});
    return {
        {"period_cycles", or_null(whole()), "period in forcing cycles; null if not periodic"},
        {"impacts_per_period", or_null(whole()), "contacts per period"},
        {"chatter_impacts_per_period", or_null(whole()),
         "impacts of chatter in addition to the contacts"},
        {"sticks_per_period", or_null(whole()), "sticking phases per period"},
        {"symmetric", or_null(flag()), "true if a shift by half a period gives the mirror image"},
        {"stable", or_null(flag()), "true if all multipliers lie inside the unit circle"},
        {"closure", or_null(number()),
         "relative distance between a state of the orbit and its return"},
        {"multipliers", or_null(multipliers), "Floquet multipliers, by descending modulus"},
        {"orbit", or_null(orbit), "a state of the orbit"},
        {"capture", or_null(capture()), "capture of the run by the orbit"}};
}

Keys rhythm_keys() {
    return {
        {"cycles_with", numbers(), "fractions of cycles with 0, 1, 2, ... contacts"},
        {"share_two_impacts", number(), "fraction of cycles with two contacts"},
        {"z_moving",
         object_of(
             {time_key("middle of ten cycles"),
              {"z", numbers(), "contacts per cycle in these ten"}}),
         "moving average of z"},
        {"synchronised",
         object_of(
             {{"share", number(), "fraction of the contacts that lie in synchronised stretches"},
              {"longest_half_cycles", whole(), "length of the longest such stretch"}}),
         "synchronisation of the contacts with the forcing (1:1 resonance)"},
        {"stretches",
         object_of(
             {{"tau_start", numbers(), "start of each stretch"},
              {"tau_end", numbers(), "end of each stretch"},
              {"synchronised", list_of(flag()), "true for a synchronised stretch"},
              {"contacts", list_of(whole()), "number of contacts in the stretch"}}),
         "synchronised and other stretches, in order of time"}};
}

Json regime() {
    const Keys what = {
        {"type", regime_name(), "I to VI, or none"},
        {"description", text(), "description of the regime"},
        {"z", number(),
         "contacts per cycle: of the orbit if periodic, else from the first contact to the last"},
        {"z_overall", number(),
         "contacts per cycle from the first contact to the last, periodic or not"},
        {"contacts", whole(),
         "contacts in the window; a chatter that ends in a sticking phase counts as one"},
        {"periodic", flag(), "true if a stable orbit attracts the motion"}};
    return object_of(what + orbit_keys() + rhythm_keys());
}

Json perturbation() {
    return object_of(
        {{"start",
          object_of(
              {{"x", number(), "displacement of the oscillator, m"},
               {"x_dot", number(), "velocity of the oscillator, m per unit of tau"},
               {"y", number(), "displacement of the ball, m"},
               {"y_dot", number(), "velocity of the ball, m per unit of tau"}}),
          "perturbation of the start"},
         time_key("times of the series, up to the end of the shorter run"),
         {"x", numbers(), "displacement of the oscillator in the second run, m"},
         {"x_dot", numbers(), "velocity of the oscillator in the second run"},
         {"y", numbers(), "displacement of the ball in the second run, m"},
         {"y_dot", numbers(), "velocity of the ball in the second run"},
         {"impacts", touches(), "impacts of the second run"},
         {"distance", numbers(),
          "Euclidean length of the difference in (x', x, y', y), through impacts"},
         {"predicted",
          object_of(
              {{"lambda1", or_null(number()),
                "largest exponent by qr over the impacts of the stretch in slope; null without "
                "one"},
               {"distance", list_of(or_null(number())),
                "length of the tangent vector; null where it overflows"}}),
          "prediction of the linear theory"},
         {"slope",
          object_of(
              {{"lambda1", or_null(number()), "slope of ln(distance)"},
               {"tau_start", or_null(number()), "start of the stretch"},
               {"tau_end", or_null(number()), "end of the stretch"}}),
          "fit over the stretch in which distance is within 10 % of the prediction; null with "
          "fewer than three impacts there"},
         {"parted", or_null(number()),
          "time from which the impacts of both runs no longer correspond; null if they always "
          "do"}});
}

/// A part that is null if the time limit left no time to compute it.
Key part(const std::string& name, const std::string& schema, const std::string& description) {
    return optional({name, or_null(reference(schema)), description});
}

Json simulation() {
    return object_of(
        sealed_keys("SimulationParameters") +
        Keys{
            {"status", reference("RunStatus"), "how the run ended"},
            part("series", "Series", "the motion"),
            part("impacts", "Impacts", "every impact"),
            {"sticking", reference("Sticking"), "every sticking phase"},
            optional(
                {"touches", reference("Touches"),
                 "grazing contacts without an impact; absent if there are none"}),
            part("exponents", "Exponents", "Lyapunov exponents of the window"),
            optional(
                {"windows", list_of(reference("WindowExponents")),
                 "Lyapunov exponents of each requested window"}),
            part(
                "eigenvalues", "Eigenvalues",
                "moduli of the eigenvalues of J, M, T at each impact"),
            part("matrices", "Matrices", "transfer matrices J, M, T at each impact"),
            part("section", "Section", "Poincare sections, at impact and stroboscopic"),
            part("energy", "Energy", "energy balance, amplitudes and decay, per unit of m1 in m^2"),
            part("regime", "Regime", "regime I to VI with its evidence"),
            part(
                "manifold", "RunManifold",
                "slow invariant manifold and the half cycles of the run"),
            part(
                "perturbation", "Perturbation",
                "a second run with a perturbed start, and its distance from the first")});
}

}  // namespace

void add_simulation(Json& schemas) {
    schemas["Simulation"] = simulation();
    schemas["RunStatus"] = run_status();
    schemas["Series"] = with_si(series());
    schemas["Impacts"] = with_si(impacts());
    schemas["Sticking"] = with_si(sticking());
    schemas["Touches"] = with_si(touches());
    schemas["Eigenvalues"] = with_si(eigenvalues());
    schemas["Matrices"] = with_si(matrices());
    schemas["Section"] = with_si(section());
    schemas["Energy"] = with_si(energy());
    schemas["Regime"] = with_si(regime());
    schemas["Perturbation"] = with_si(perturbation());
}

}  // namespace vines::api::document
