// The answer of /v1/simulate, part by part.
#include "api/openapi/columns.hpp"
#include "api/openapi/exponents.hpp"
#include "api/openapi/schemas.hpp"
#include "api/openapi/systems.hpp"
#include "api/openapi/twins.hpp"
#include "api/openapi/words.hpp"

namespace vines::api::document {

Keys impact_section_keys() {
    return {
        {"side", list_of(side()), "sign of x - y"},
        {"phase", numbers(), "of the forcing, Omega tau + phi, in [0, 2 pi)"},
        {"x", numbers(), "displacement of the oscillator, m"},
        {"x_dot_after", numbers(), "velocity of the oscillator"},
        {"y_dot_after", numbers(), "velocity of the free mass"},
        {"time_difference", list_of(or_null(number())),
         "since the impact before; null for the run's first"}};
}

Keys stroboscopic_keys() {
    return {
        {"x", numbers(), "displacement of the oscillator, m"},
        {"x_dot", numbers(), "velocity of the oscillator"},
        {"y", numbers(), "displacement of the free mass, m"},
        {"y_dot", numbers(), "velocity of the free mass"}};
}

namespace {

Key moments(const std::string& description) { return {"tau", numbers(), description}; }

Json run_status() {
    return with_si(object_of(
        {{"reason", one_of({"tau_end", "max_impacts", "deadline"}),
          "deadline: the server's limit for one request"},
         {"tau", number(), "how far the run came"},
         {"message", text(), "a sentence"}}));
}

Json series() {
    return object_of(
        Keys{moments("equal steps, and the end of the run")} + stroboscopic_keys() +
        Keys{{"x_ddot", numbers(), "acceleration of the oscillator between impacts"}});
}

Json impacts() {
    return object_of(
        {moments("moment"),
         {"side", list_of(side()), "sign of x - y"},
         {"phase", numbers(), "of the forcing, Omega tau + phi, in [0, 2 pi)"},
         {"x", numbers(), "displacement of the oscillator, m"},
         {"x_dot_before", numbers(), "velocity of the oscillator"},
         {"x_dot_after", numbers(), "velocity of the oscillator"},
         {"y_dot_before", numbers(), "velocity of the free mass"},
         {"y_dot_after", numbers(), "velocity of the free mass"},
         {"x_ddot_before", numbers(), "acceleration of the oscillator"},
         {"relative_speed", numbers(), "modulus of x' - y' before"},
         {"impulse", numbers(), "epsilon (y'+ - y'-): on the free mass, per m1"},
         {"relative_speed_ratio", list_of(or_null(number())),
          "relative_speed over its median: 0 is a tangent contact"},
         {"grazing", list_of(flag()), "whether it is nearly tangent"}});
}

Json sticking() {
    return object_of(
        {{"side", list_of(side()), "of the wall"},
         {"tau_start", numbers(), "the end of the chatter that leads there"},
         {"tau_end", numbers(), "release, or the end of the run"},
         {"impacts", list_of(whole()), "of that chatter, all on this side"}});
}

Json touches() {
    return object_of({moments("moment"), {"side", list_of(side()), "sign of x - y"}});
}

Json eigenvalues() {
    const Json moduli = list_of(list_of(number(), 4));
    return object_of(
        {moments("moment"),
         {"J", moduli, "of the flight before it: four moduli each, descending"},
         {"M", moduli, "of the impact"},
         {"T", list_of(four_exponents()),
          "of T = M J; null where rounding leaves none, at the end of a chatter"},
         {"M_condition", list_of(or_null(number())),
          "condition number of M in the Frobenius norm; null for R = 0"}});
}

Json matrices() {
    const Json by_rows = list_of(list_of(list_of(number(), 4), 4));
    return object_of(
        {moments("moment"),
         {"order", list_of(one_of({"x_dot", "x", "y_dot", "y"}), 4), "of rows and columns"},
         {"J", by_rows, "of the flight before it, by rows"},
         {"M", by_rows, "of the impact, by rows"},
         {"T", by_rows, "T = M J, by rows"}});
}

Json section() {
    return object_of(
        {{"impact",
          object_of(Keys{moments("of each impact in the window")} + impact_section_keys()),
          "at impact"},
         {"stroboscopic",
          object_of(
              Keys{moments("once each cycle, section_phase after its start")} +
              stroboscopic_keys()),
          "at whole cycles"}});
}

Keys decay_keys() {
    return {
        {"tau_half", or_null(number()), "when a half of the energy is left; null if not reached"},
        {"tau_tenth", or_null(number()), "when a tenth is left; null if not reached"}};
}

Json energy() {
    return with_joules(object_of(
        {{"window", interval(), "what it refers to"},
         {"input", number(), "work of the forcing"},
         {"damper", number(), "dissipated by 2 zeta x'"},
         {"impacts", number(), "dissipated in impacts"},
         {"stored", number(), "at the end less at the start"},
         {"residual", number(), "what the balance misses"},
         {"share_impacts", or_null(number()), "of what is dissipated; null where nothing is"},
         {"at_start", number(), "stored energy at the start"},
         {"at_end", number(), "stored energy at the end"},
         {"rms", number(), "of x, m"},
         {"peak", number(), "of the modulus of x, m"},
         {"without_absorber",
          object_of(
              {{"rms", number(), "of x, m"},
               {"peak", number(), "of the modulus of x, m"},
               {"amplitude", or_null(number()),
                "once that is steady, m; null undamped at resonance"}}),
          "of the same oscillator, start and window without the free mass"},
         {"rms_ratio", or_null(number()), "with over without"},
         {"peak_ratio", or_null(number()), "with over without"},
         optional(
             {"decay",
              object_of(
                  decay_keys() +
                  Keys{
                      {"without_absorber", object_of(decay_keys()),
                       "the same without the free "
                       "mass"}}),
              "with G = 0 only"})}));
}

Json capture() {
    return object_of(
        {{"tau", or_null(number()), "when the orbit captured the run; null if it ends before"},
         {"status", one_of({"captured", "on_its_way"}), "which of them"},
         {"chaotic_before", or_null(flag()),
          "whether a chaotic transient came before; null: not known"},
         {"exponents_before", object_of(final_keys()), "by qr, of the run up to there"},
         {"exponents_after", object_of(final_keys()), "from the multipliers"}});
}

/// All null if not periodic.
Keys orbit_keys() {
    const Json multipliers = object_of(
        {{"re", numbers(), "real part"},
         {"im", numbers(), "imaginary part"},
         {"modulus", numbers(), "by which they descend"}});
    const Json orbit = object_of(
        {{"tau", number(), "a moment of the orbit, inside a flight"},
         {"x_dot", number(), "velocity of the oscillator there"},
         {"x", number(), "displacement of the oscillator there, m"},
         {"y_dot", number(), "velocity of the free mass there"},
         {"y", number(), "displacement of the free mass there, m"}});
    return {
        {"period_cycles", or_null(whole()), "its period in forcing cycles; null if not periodic"},
        {"impacts_per_period", or_null(whole()), "contacts"},
        {"chatter_impacts_per_period", or_null(whole()), "impacts beyond those"},
        {"sticks_per_period", or_null(whole()), "stuck phases"},
        {"symmetric", or_null(flag()),
         "whether half a period later the motion is its mirror image"},
        {"stable", or_null(flag()), "whether all multipliers lie inside the unit circle"},
        {"closure", or_null(number()),
         "by how much a state of the orbit misses its return, relative"},
        {"multipliers", or_null(multipliers), "Floquet, by descending modulus"},
        {"orbit", or_null(orbit), "a state of the orbit"},
        {"capture", or_null(capture()), "of the run by the orbit"}};
}

Keys rhythm_keys() {
    return {
        {"cycles_with", numbers(), "shares of cycles with 0, 1, 2, ... contacts"},
        {"share_two_impacts", number(), "that of cycles with two"},
        {"z_moving",
         object_of(
             {moments("middle of ten cycles"), {"z", numbers(), "contacts per cycle over them"}}),
         "z along the window"},
        {"synchronised",
         object_of(
             {{"share", number(), "of the contacts in synchronised stretches"},
              {"longest_half_cycles", whole(), "of the longest such stretch"}}),
         "of the contacts"},
        {"stretches",
         object_of(
             {{"tau_start", numbers(), "of each"},
              {"tau_end", numbers(), "of each"},
              {"synchronised", list_of(flag()), "whether it is in step"},
              {"contacts", list_of(whole()), "in it"}}),
         "in step and not, one behind the other"}};
}

Json regime() {
    const Keys what = {
        {"type", regime_name(), "I to VI, or none"},
        {"description", text(), "the same in words"},
        {"z", number(),
         "contacts per cycle: of the orbit if periodic, else from the first to the last"},
        {"z_overall", number(), "from the first contact to the last, in any case"},
        {"contacts", whole(), "in the window; a chatter that ends in a stick is one"},
        {"periodic", flag(), "whether a stable orbit attracts the motion"}};
    return object_of(what + orbit_keys() + rhythm_keys());
}

Json perturbation() {
    return object_of(
        {{"start",
          object_of(
              {{"x", number(), "m"},
               {"x_dot", number(), "m per unit of tau"},
               {"y", number(), "m"},
               {"y_dot", number(), "m per unit of tau"}}),
          "the difference that was applied"},
         moments("those of the series; up to the end of the run that ends first"),
         {"x", numbers(), "the second run's displacement of the oscillator, m"},
         {"x_dot", numbers(), "its velocity"},
         {"y", numbers(), "the second run's displacement of the free mass, m"},
         {"y_dot", numbers(), "its velocity"},
         {"impacts", touches(), "of the second run"},
         {"distance", numbers(),
          "Euclidean length of the difference in (x', x, y', y), through impacts"},
         {"predicted",
          object_of(
              {{"lambda1", or_null(number()),
                "by qr, over the impacts in the stretch of slope; null without one"},
               {"distance", list_of(or_null(number())),
                "length of the tangent vector; null beyond the range of double"}}),
          "what the linear theory says of it"},
         {"slope",
          object_of(
              {{"lambda1", or_null(number()), "the slope of ln(distance)"},
               {"tau_start", or_null(number()), "of that stretch"},
               {"tau_end", or_null(number()), "of that stretch"}}),
          "fitted to the stretch in which distance is within 10 % of what is predicted; null where "
          "that holds fewer than three impacts"},
         {"parted", or_null(number()),
          "from when on the impacts of both runs no longer correspond; null: to the end they do"}});
}

/// Null where no time was left for it.
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
            {"sticking", reference("Sticking"), "every stuck phase"},
            optional({"touches", reference("Touches"), "tangent contacts, if there are any"}),
            part("exponents", "Exponents", "Lyapunov exponents of the window"),
            optional(
                {"windows", list_of(reference("WindowExponents")),
                 "of each of the windows asked for"}),
            part("eigenvalues", "Eigenvalues", "moduli of those of J, M, T at each impact"),
            part("matrices", "Matrices", "J, M, T themselves"),
            part("section", "Section", "at impact and stroboscopic"),
            part("energy", "Energy", "balance, amplitudes, decay, per unit of m1 in m^2"),
            part("regime", "Regime", "type I to VI with its evidence"),
            part(
                "manifold", "RunManifold",
                "the slow invariant manifold, and the run's half "
                "cycles"),
            part("perturbation", "Perturbation", "a second run and its distance from the first")});
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
