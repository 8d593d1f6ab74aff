// The parts `exponents` and `windows` of a simulation, and `exponents` of a measurement.
#include "api/openapi/exponents.hpp"

#include "api/openapi/schemas.hpp"
#include "api/openapi/twins.hpp"
#include "api/openapi/words.hpp"

namespace vines::api::document {

Json four_exponents() { return list_of(or_null(number()), 4); }

Json four_statuses() { return list_of(word_of_any<Status>(), 4); }

Keys final_keys() {
    return {
        {"final", four_exponents(),
         "four exponents at the window's end, descending, per unit of tau"},
        {"status", four_statuses(),
         "of each: ok, minus_infinity (rank was lost at a stick or by R = 0), not_converged"}};
}

namespace {

/// Of a window of a run with its histories, of one of `windows` without, of a measurement.
enum class Of { run, windows, measurement };

Keys history_keys() {
    Keys keys = {{"tau", numbers(), "every impact, or every second, fourth, ..."}};
    for (const char* name : {"lambda1", "lambda2", "lambda3", "lambda4"})
        keys.push_back({name, list_of(or_null(number())), "of the window up to there"});
    return keys;
}

Keys estimator_keys(Of of, const Keys& of_history = {}) {
    Keys keys = final_keys();
    if (of != Of::measurement)
        keys.push_back(
            {"slope", or_null(number()),
             "how lambda1(tau) tau grows over tau without the first tenth of the impacts; null of "
             "fewer than 24 impacts, or where lambda1 is not converged"});
    if (of != Of::windows)
        keys.push_back({"history", object_of(history_keys() + of_history), "of each up to there"});
    return keys;
}

Json qr(Of of) {
    return object_of(
        estimator_keys(of) +
        Keys{{"standard_error", four_exponents(), "of each: its standard error"}});
}

/// Of a measurement that falls into stretches it has a window of its own.
Keys own_window(Of of) {
    if (of != Of::measurement) return {};
    return {{"window", or_null(interval()), "of the longest stretch"}};
}

Json raw_product(Of of) {
    const Keys floors = {
        {"rounding_floor", list_of(or_null(number())), "of the window up to there"}};
    return object_of(
        estimator_keys(of, floors) + own_window(of) +
        Keys{{"rounding_floor", or_null(number()), "below which all is rounding"}});
}

Keys window_keys() {
    return {
        {"window", or_null(interval()),
         "from the first impact at or after tau_s to the last at or before tau_e; null without an "
         "impact"},
        {"impacts", whole(), "in it"},
        {"sum_rule_residual", or_null(number()),
         "by how much qr misses, or may miss, the sum rule"}};
}

Keys estimators(Of of) {
    const Key by_qr = {"qr", qr(of), "by QR decompositions"};
    return {
        of == Of::measurement ? by_qr : optional(by_qr),
        optional(
            {"eigenvalues", object_of(estimator_keys(of) + own_window(of)),
             "by the moduli of the eigenvalues of the product"}),
        optional(
            {"raw_product", raw_product(of), "by the product itself, down to its rounding floor"})};
}

Keys verdict_keys() {
    return {
        optional(
            {"verdict", word_of_any<Verdict>(),
             "chaotic, regular, not_decided, or null where there is nothing to judge; with qr, as "
             "the next two"}),
        optional({"verdict_sigmas", or_null(number()), "lambda1 over its standard error"}),
        optional({"verdict_reason", text(), "what the verdict rests on, a sentence"})};
}

Keys stretch_keys() {
    const Json stretches =
        object_of({{"tau_start", numbers(), "of each"}, {"tau_end", numbers(), "of each"}});
    return {
        optional({"duration", number(), "of all known stretches together, in tau"}),
        optional({"stretches", stretches, "those without an impact left out, or a gap"})};
}

}  // namespace

void add_exponents(Json& schemas) {
    schemas["Exponents"] = with_si(object_of(window_keys() + verdict_keys() + estimators(Of::run)));
    schemas["WindowExponents"] = with_si(object_of(
        Keys{{"asked", interval(), "the window as asked for"}} + window_keys() + verdict_keys() +
        estimators(Of::windows)));
    schemas["MeasuredExponents"] =
        with_si(object_of(window_keys() + estimators(Of::measurement) + stretch_keys()));
}

}  // namespace vines::api::document
