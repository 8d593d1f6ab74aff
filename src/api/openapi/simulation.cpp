// The responses of /v1/simulate, one schema for each part, and of /v1/manifold.
#include "api/openapi/parts.hpp"
#include "api/properties.hpp"

namespace vines::api::document {

Keys impact_section_keys() {
    Keys keys = columns_of(impact_section_columns);
    keys.erase(keys.begin());
    return keys;
}

namespace {

Json capture() {
    return object_of(
        {{"tau", or_null(number()),
          "time at which the orbit captured the run; null if the run ends before; if the time "
          "limit ended the run, it can be later than the capture"},
         {"status", one_of({"captured", "on_its_way"}),
          "captured, or on_its_way: the run ends before its capture"},
         {"chaotic_before", or_null(flag()),
          "true if chaos before the capture is shown, otherwise null"},
         {"exponents_before", object_of(final_keys()),
          "exponents of the run before the capture, or of the whole run if that comes later, by "
          "qr"},
         {"exponents_after", object_of(final_keys()),
          "exponents of the orbit, from its multipliers"}});
}

/// All are null unless the motion is periodic.
Keys orbit_keys() {
    const Json multipliers = object_of(
        {{"re", numbers(), "real part"},
         {"im", numbers(), "imaginary part"},
         {"modulus", numbers(), "modulus, descending"}});
    return or_null(
        {values_of(properties::orbit),
         {"multipliers", multipliers, "Floquet multipliers, by descending modulus"},
         {"orbit", object_of(values_of(properties::orbit_state)), "a state of the orbit"},
         {"capture", capture(), "capture of the run by the orbit"}});
}

/// A part that is null if the time limit left no time to compute it.
Keys part(const std::string& name, const std::string& schema, const std::string& description) {
    return {name + "?", or_null(reference(schema)), description};
}

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

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
void add_simulation(Json& schemas) {
    schemas["Simulation"] = object_of(
        {sealed_keys("SimulationParameters"),
         {"status", reference("RunStatus"), "how the run ended"},
         part("series", "Series", "the motion"),
         part("impacts", "Impacts", "every impact"),
         {"sticking", reference("Sticking"), "every sticking phase; always present"},
         {"touches?", reference("Touches"),
          "grazing contacts without an impact; with impacts, absent if there are none"},
         part("exponents", "Exponents", "Lyapunov exponents of the window"),
         {"windows?", list_of(reference("WindowExponents")),
          "Lyapunov exponents of each requested window"},
         part("eigenvalues", "Eigenvalues", "moduli of the eigenvalues of J, M, T at each impact"),
         part("matrices", "Matrices", "transfer matrices J, M, T at each impact"),
         part("section", "Section", "Poincare sections, at impact and stroboscopic"),
         part("energy", "Energy", "energy balance, amplitudes and decay, per unit of m1 in m^2"),
         part("regime", "Regime", "regime I to VI with its evidence"),
         part("manifold", "RunManifold", "slow invariant manifold and the half cycles of the run"),
         part(
             "perturbation", "Perturbation",
             "a second run with a perturbed start, and its distance from the first; only with the "
             "field perturbation")});
    schemas["RunStatus"] = object_of(
        {{"reason", one_of({"tau_end", "max_impacts", "deadline"}),
          "tau_end, max_impacts, deadline (the time limit of the server for one request), or on "
          "the command line interrupted"},
         quantity.tau.with("time at which the run ended"),
         {"message", text(), "a sentence"}});
    schemas["Series"] =
        object_of({columns_of(series_columns), optional(columns_of(relative_columns))});
    schemas["Impacts"] = table_of(impact_columns);
    schemas["Sticking"] = table_of(sticking_columns);
    schemas["Touches"] = table_of(touch_columns);
    schemas["Eigenvalues"] = table_of(moduli_columns);
    schemas["Matrices"] = table_of(matrix_columns);
    schemas["Section"] = object_of(
        {{"impact", table_of(impact_section_columns), "Poincare section at impact"},
         {"stroboscopic",
          object_of(
              {column_of(quantity.tau.with("one time per cycle, section_phase after its start")),
               columns_of(state_columns)}),
          "stroboscopic section, once per cycle"}});
    const Keys decay = values_of(properties::decay);
    schemas["Energy"] = with_joules(object_of(
        {values_of(properties::balance),
         {"without_absorber", object_of(values_of(properties::unattached)),
          "the same oscillator, start and window without the ball"},
         values_of(properties::energy_ratio),
         {"decay?",
          object_of({decay, {"without_absorber", object_of(decay), "the same without the ball"}}),
          "decay of the energy; only if G = 0"}}));
    schemas["Regime"] = object_of(
        {{"type", regime_name(), "I to VI, or none"},
         {"description", text(), "description of the regime"},
         values_of(properties::rhythm),
         orbit_keys(),
         {"quasi_periodic", or_null(object_of(values_of(properties::quasi_periodic))),
          "null unless the motion is on a torus: its stroboscopic section is a smooth closed "
          "curve"},
         {"cycles_with", numbers(), "fractions of cycles with 0, 1, 2, ... contacts"},
         {"share_two_impacts", number(), "fraction of cycles with two contacts"},
         {"z_moving", table_of(moving_z_columns), "moving average of z"},
         {"synchronised", object_of(values_of(properties::synchrony)),
          "synchronisation of the contacts with the forcing (1:1 resonance)"},
         {"stretches", table_of(stretch_columns),
          "synchronised and other stretches, in order of time"}});
    const Keys start = {
        quantity.x, quantity.x_dot.with("velocity of the oscillator, m per unit of tau"),
        quantity.y, quantity.y_dot.with("velocity of the ball, m per unit of tau")};
    const Keys predicted = {
        {"lambda1", or_null(number()),
         "largest exponent by qr over the impacts of the stretch in slope; null without one"},
        column_of(quantity.predicted_distance)};
    const Keys slope = {
        {"lambda1", or_null(number()), "slope of ln(distance)"},
        quantity.tau_start.with("start of the stretch").or_null(),
        quantity.tau_end.with("end of the stretch").or_null()};
    schemas["Perturbation"] = object_of(
        {{"start", object_of(start), "perturbation of the start"},
         columns_of(perturbation_columns),
         {"impacts", table_of(touch_columns), "impacts of the second run"},
         column_of(quantity.distance),
         {"predicted", object_of(predicted), "prediction of the linear theory"},
         {"slope", object_of(slope),
          "fit over the stretch in which distance is within 10 % of the prediction; null with "
          "fewer than three impacts there"},
         quantity.parted});
}

void add_manifolds(Json& schemas) {
    const Json recommendation = object_of(values_of(properties::recommendation));
    schemas["SlowManifold"] = object_of(
        {manifold_keys(),
         {"recommended", or_null(recommendation),
          "the b whose worst motion at this F and f has the smallest rms of x; null if no b "
          "reduces the motion, or if the time limit ended the search"},
         {"robust", or_null(recommendation),
          "the b with the smallest tolerance_ratio; null if it is the recommended one or hardly "
          "better"}});
    const Keys points = {
        column_of(quantity.tau.with("end of each half cycle")), columns_of(branch_columns)};
    schemas["RunManifold"] = object_of(
        {optional(manifold_keys()),
         {"points", object_of(points),
          "the run: maximum of |x| and mean of |y'| in each half cycle"}});
    schemas["Manifold"] = object_of(
        {sealed_keys("System"),
         {"manifold", reference("SlowManifold"),
          "fold, branches, end points, and a recommended b"}});
}

}  // namespace vines::api::document
