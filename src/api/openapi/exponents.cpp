// The parts `exponents` and `windows` of a simulation, and `exponents` of a measurement.
#include "api/columns.hpp"
#include "api/openapi/parts.hpp"

namespace vines::api::document {

Keys final_keys() {
    return {
        {"final", four_exponents(),
         "four exponents at the end of the window, descending, per unit of tau"},
        {"status", list_of(enum_schema<Status>(), 4),
         "for each exponent: ok, minus_infinity (a sticking phase or R = 0 reduced the rank), "
         "not_converged"}};
}

namespace {

/// The three kinds of windows: of a run, with histories; an entry of `windows`, without; of a
/// measurement.
enum class Of { run, windows, measurement };

Keys estimator_keys(Of of, const Keys& of_history = {}) {
    const Keys slope = {
        "slope", or_null(number()),
        "slope of lambda1(tau) tau over tau, without the first tenth of the impacts; null with "
        "fewer than 24 impacts, or if lambda1 is not converged"};
    const Keys history = {
        "history", object_of({columns_of(history_columns), of_history}),
        "each exponent as a function of time"};
    return {
        final_keys(), of == Of::measurement ? Keys() : slope, of == Of::windows ? Keys() : history};
}

/// The window of one estimator: a record with gaps has several stretches.
Keys own_window(Of of) {
    if (of != Of::measurement) return {};
    return {"window", or_null(interval()), "the longest stretch"};
}

Keys estimators(Of of) {
    const Json qr = object_of(
        {estimator_keys(of),
         {"standard_error", four_exponents(),
          "standard error of each exponent as an estimate for an infinite run"},
         {"degrees_of_freedom", whole(), "degrees of freedom of the standard errors"},
         {"interval",
          object_of(
              {{"level", number(), "probability that an interval contains the exponent"},
               {"low", four_exponents(), "lower ends"},
               {"high", four_exponents(), "upper ends"}}),
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

Keys window_keys() {
    return {
        {"window", or_null(interval()),
         "from the first impact at or after tau_s to the last at or before tau_e; null without an "
         "impact"},
        {"impacts", whole(), "number of impacts in the window"},
        {"sum_rule_residual", or_null(number()),
         "error of qr in the sum rule of the exponents, or the bound of its rounding errors if "
         "that exceeds 1e-6"}};
}

Keys verdict_keys() {
    return {
        {"verdict?", enum_schema<Verdict>(),
         "chaotic over this window, regular, not_decided, or null if there is no motion to judge; "
         "present with qr, as the next two keys"},
        {"verdict_sigmas?", or_null(number()), "lambda1 over its standard error"},
        {"verdict_reason?", text(), "reason for the verdict, a sentence"}};
}

}  // namespace

void add_exponents(Json& schemas) {
    schemas["Exponents"] = object_of({window_keys(), verdict_keys(), estimators(Of::run)});
    schemas["WindowExponents"] = object_of(
        {{"asked", interval(), "requested window"},
         window_keys(),
         verdict_keys(),
         estimators(Of::windows)});
    const Keys stretches = {
        column_of(quantity.tau_start.with("start of each stretch")),
        column_of(quantity.tau_end.with("end of each stretch"))};
    schemas["MeasuredExponents"] = object_of(
        {window_keys(),
         estimators(Of::measurement),
         {"duration?", number(), "total length of the stretches, in tau"},
         {"stretches?", object_of(stretches),
          "the parts of the record without a gap and without an excluded impact"}});
}

}  // namespace vines::api::document
