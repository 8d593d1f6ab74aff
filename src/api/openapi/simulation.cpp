// The responses of /v1/simulate, one schema for each part, and of /v1/manifold; the parts that
// other responses share: parameters, provenance and exponents.
#include "api/openapi/parts.hpp"
#include "api/properties.hpp"

namespace vines::api::document {

Keys impact_section_keys() {
    Keys keys = columns_of(impact_section_columns);
    keys.erase(keys.begin());
    return keys;
}

Keys answer_keys(const std::string& parameters) {
    return {
        {"version", word, "version of the program"},
        {"parameters", reference(parameters), "all parameters, resolved"},
        {"warnings", list_of(word), "sentences"}};
}

Keys sealed_keys(const std::string& parameters) {
    return {
        answer_keys(parameters),
        {"provenance", reference("Provenance"), "request and program that produced the response"}};
}

namespace {

Keys system_keys() {
    const Json load = object_of(
        {{"kind", one_of({"record", "half_sine", "chirp", "noise", "harmonics"}), "of the load"},
         {"length", number_or_null, "in tau; null for harmonics"},
         {"sampling_error", number,
          "bound of the difference between the motion of the base and its formula, m; 0 if they "
          "agree to rounding"}});
    return {
        values_of(properties::reduced),
        {"forcing?", load, "load, if it replaces F and f"},
        {"restitution_plus?", reference("RestitutionTable"),
         "R of the wall at x - y = b as a function of the speed, if it is not constant"},
        {"restitution_minus?", reference("RestitutionTable"), "the same at x - y = -b"},
        {"origin", map_of(word), "source of each value"}};
}

Keys si_system(const Keys& keys) {
    return {"si?", object_of(keys), "the same system in SI, if the request or the preset is in SI"};
}

Keys derived() {
    const Keys keys = {values_of(properties::derived), optional(values_of(properties::derived_si))};
    return {"derived", object_of(keys), "values derived from these"};
}

/// The window of a run, with histories; an entry of `windows`, without; that of a measurement.
enum class Of { run, windows, measurement };

Keys estimator_keys(Of of, const Keys& of_history = {}) {
    const Keys slope = {
        "slope", number_or_null,
        "slope of lambda1(tau) tau over tau, without the first tenth of the impacts; null with "
        "fewer than 24 impacts, or if lambda1 is not converged"};
    const Keys history = {
        "history", object_of({columns_of(history_columns), of_history}),
        "each exponent as a function of time"};
    return {
        values_of(properties::final_exponents), of == Of::measurement ? Keys() : slope,
        of == Of::windows ? Keys() : history};
}

/// The window of one estimator: a record with gaps has several stretches.
Keys own_window(Of of) {
    if (of != Of::measurement) return {};
    return {"window", interval_or_null, "the longest stretch"};
}

Keys estimators(Of of) {
    const Json qr = object_of(
        {estimator_keys(of),
         {"standard_error", exponents,
          "standard error of each exponent as an estimate for an infinite run"},
         {"degrees_of_freedom", whole, "degrees of freedom of the standard errors"},
         {"interval",
          object_of(
              {{"level", number, "probability that an interval contains the exponent"},
               {"low", exponents, "lower ends"},
               {"high", exponents, "upper ends"}}),
          "interval of each exponent, by Student's distribution"}});
    const Keys floors =
        column_of(quantity.rounding_floor.with("rounding floor from the window's start to tau"));
    const Json raw_product =
        object_of({estimator_keys(of, floors), own_window(of), quantity.rounding_floor});
    return {
        {of == Of::measurement ? "qr" : "qr?", qr, "by QR decompositions"},
        {"eigenvalues?", object_of({estimator_keys(of), own_window(of)}),
         "by the moduli of the eigenvalues of the product; the history has at most 2048 entries"},
        {"raw_product?", raw_product, "by the product itself, down to its rounding floor"}};
}

Keys verdict_keys() {
    return {
        {"verdict?", verdict,
         "chaotic over this window, regular, not_decided, or null if there is no motion to judge; "
         "present with qr, as the next two keys"},
        {"verdict_sigmas?", number_or_null, "lambda1 over its standard error"},
        {"verdict_reason?", word, "reason for the verdict, a sentence"}};
}

Json capture() {
    return object_of(
        {{"tau", number_or_null,
          "time at which the orbit captured the run; null if the run ends before; if the time "
          "limit ended the run, it can be later than the capture"},
         {"status", one_of({"captured", "on_its_way"}),
          "captured, or on_its_way: the run ends before its capture"},
         {"chaotic_before", or_null(flag),
          "true if chaos before the capture is shown, otherwise null"},
         {"exponents_before", object_of(values_of(properties::final_exponents)),
          "exponents by qr of the run before the capture, or of the whole run if that is later"},
         {"exponents_after", object_of(values_of(properties::final_exponents)),
          "exponents of the orbit, from its multipliers"}});
}

/// All are null unless the motion is periodic.
Keys orbit_keys() {
    const Json multipliers = object_of(
        {{"re", list_of(number), "real part"},
         {"im", list_of(number), "imaginary part"},
         {"modulus", list_of(number), "modulus, descending"}});
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
        {"R", number, "restitution coefficient of both walls"},
        {"Omega", number, "forcing frequency over omega0"},
        {"b", number, "clearance, m"},
        {"fold", manifold_point(), "the point with the smallest C"},
        {"activation_amplitude", number,
         "C at the fold, m: below it the absorber cannot be activated"},
        {"symmetry_breaking", or_null(manifold_point()),
         "the point at which the impacts become asymmetric; null if the second contact is first"},
        {"second_contact", manifold_point(),
         "the point at which the ball meets the same wall a second time: this motion ends there"},
        {"stable_ends_by", one_of({"symmetry_breaking", "second_contact"}),
         "the point that comes first"},
        {"stable", table_of(branch_columns), "branch from the fold to the end of stability"},
        {"unstable", table_of(branch_columns), "branch below the fold"},
        {"asymmetric", table_of(branch_columns), "branch beyond the symmetry breaking"},
        {"free_amplitude", number_or_null,
         "steady amplitude without the absorber, m; null if undamped at resonance"},
        {"b_at_free_amplitude", number_or_null,
         "the b that puts the fold at free_amplitude, m: the limit of activation, not a "
         "recommendation"}};
}

void add_systems(Json& schemas) {
    schemas["RestitutionTable"] = object_of(
        {{"speed", list_of(number), "|x' - y'| before the impact, m per unit of tau"},
         {"R", list_of(number), "restitution coefficient at each speed, linear in between"}});
    schemas["System"] = object_of({system_keys(), si_system(values_of(properties::si)), derived()});
    const Keys start_in_si = {
        {"x_velocity0", number, "x_dot0 in m/s"}, {"y_velocity0", number, "y_dot0 in m/s"}};
    schemas["SimulationParameters"] = object_of(
        {system_keys(),
         si_system({values_of(properties::si), start_in_si}),
         {"x0", number, "displacement of the oscillator at tau = 0, m"},
         {"x_dot0", number, "velocity of the oscillator at tau = 0, m per unit of tau"},
         {"y0", number, "displacement of the ball at tau = 0, m"},
         {"y_dot0", number, "velocity of the ball at tau = 0, m per unit of tau"},
         {"tau_end", number, "requested length of the run"},
         {"cycles", number, "requested length of the run in forcing cycles"},
         {"window", interval, "requested window"},
         {"samples_per_cycle", number, "samples of the series per forcing cycle"},
         {"settle_cycles", number, "as requested"},
         {"section_phase", number, "phase of the stroboscopic section, rad"},
         {"max_points", whole, "as requested, or as reduced by a limit of the server"},
         {"max_impacts", whole, "as requested"},
         derived()});
    schemas["Provenance"] = object_of(
        {{"route", word, "route of the request"},
         {"commit", word, "commit of the program; empty if unknown"},
         {"answer_limit", or_null(whole),
          "size in bytes to which the response was thinned, with a warning; null if it was not"},
         {"request", map_of(Json::object()),
          "fields of the request, sorted, without a record or a list of impacts"},
         {"record_sha256?", word, "for an identification: hash of the file or JSON that was sent"},
         {"sha256", word, "hash of the response's content without provenance"}});
}

void add_exponents(Json& schemas) {
    schemas["Exponents"] =
        object_of({values_of(properties::window), verdict_keys(), estimators(Of::run)});
    schemas["WindowExponents"] = object_of(
        {{"asked", interval, "requested window"},
         values_of(properties::window),
         verdict_keys(),
         estimators(Of::windows)});
    const Keys stretches = {
        column_of(quantity.tau_start.with("start of each stretch")),
        column_of(quantity.tau_end.with("end of each stretch"))};
    schemas["MeasuredExponents"] = object_of(
        {values_of(properties::window),
         estimators(Of::measurement),
         {"duration?", number, "total length of the stretches, in tau"},
         {"stretches?", object_of(stretches),
          "the parts of the record without a gap and without an excluded impact"}});
}

// NOLINTNEXTLINE(readability-function-size): a table
void add_parts(Json& schemas) {
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
          "tau_end, max_impacts, deadline (the server's time limit for one request, or others wait "
          "for its thread), or on the command line interrupted"},
         quantity.tau.with("time at which the run ended"),
         {"message", word, "a sentence"}});
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
          "decay of the energy, under gravity of that above rest; only without forcing"}}));
    schemas["Regime"] = object_of(
        {{"type", regime, "I to VI, or none"},
         {"description", word, "description of the regime"},
         values_of(properties::rhythm),
         orbit_keys(),
         {"quasi_periodic", or_null(object_of(values_of(properties::quasi_periodic))),
          "null unless on a torus: the stroboscopic section is a smooth closed curve"},
         {"cycles_with", list_of(number), "fractions of cycles with 0, 1, 2, ... contacts"},
         {"share_two_impacts", number, "fraction of cycles with two contacts"},
         {"z_moving", table_of(moving_z_columns), "moving average of z"},
         {"synchronised", object_of(values_of(properties::synchrony)),
          "synchronisation of the contacts with the forcing (1:1 resonance)"},
         {"stretches", table_of(stretch_columns),
          "synchronised and other stretches, in order of time"}});
    const Keys predicted = {
        {"lambda1", number_or_null,
         "largest exponent by qr over the impacts of the stretch in slope; null without one"},
        column_of(quantity.predicted_distance)};
    const Keys slope = {
        {"lambda1", number_or_null, "slope of ln(distance)"},
        quantity.tau_start.with("start of the stretch").or_null(),
        quantity.tau_end.with("end of the stretch").or_null()};
    schemas["Perturbation"] = object_of(
        {{"start", object_of(values_of(properties::difference)), "perturbation of the start"},
         columns_of(perturbation_columns),
         {"impacts", table_of(touch_columns), "impacts of the second run"},
         column_of(quantity.distance),
         {"predicted", object_of(predicted), "prediction of the linear theory"},
         {"slope", object_of(slope),
          "fit over the stretch in which distance is within 10 % of the prediction; its values are "
          "null with fewer than three impacts there"},
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
          "the b with the smallest tolerance_ratio; null if recommended is it or hardly worse"}});
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

}  // namespace

void add_simulation(Json& schemas) {
    for (const auto add : {add_parts, add_systems, add_exponents, add_manifolds}) add(schemas);
}

}  // namespace vines::api::document
