// The lines of the response of /v1/design.
#include "api/openapi/parts.hpp"

namespace vines::api::document {

namespace {

/// A key for each objective; a response has that of its request.
Keys objective_keys(const Json& value, const std::string& description) {
    Keys keys;
    for (const std::string& name : find(design_fields(), "objective")->choices)
        keys = {keys, {name + "?", value, description}};
    return keys;
}

Keys largest_over_band() {
    return objective_keys(
        or_null(number()),
        "largest value over the band, m, m/s, m/s^2 or s; null if a motion has too many impacts");
}

Keys absorber_keys() {
    return {
        {"b", number(), "clearance, m"},
        {"R", number(), "restitution coefficient of both walls"},
        {"m2", number(), "mass of the ball, kg"},
        largest_over_band(),
        {"f", or_null(number()), "frequency of the worst case, Hz; null without a band"},
        {"acceleration?", number(), "amplitude of the base there, m/s^2"},
        {"F?", number(), "the same as a displacement, m"},
        {"load_factor?", number(), "with forcing: factor on the load"},
        {"initial_velocity?", number(), "that of m1, m/s"}};
}

Json margin() {
    const Json pair = list_of(number());
    return object_of(
        {{"five_percent", pair,
          "smallest and largest factor on the value with at most 5 % more of the objective, as far "
          "as tried"},
         {"twenty_percent", pair, "the same for 20 %"}});
}

Json linear(const Keys& more) {
    return object_of(
        {largest_over_band(),
         {"f", or_null(number()), "frequency of the largest value, Hz; null without a band"},
         more});
}

Json fractions(const Keys& value) {
    return list_of(object_of(
        {value,
         {"samples", whole(), "number of samples"},
         {"fraction", number(), "fraction of the samples"},
         {"interval", interval(), "95 % interval of its probability"}}));
}

}  // namespace

// NOLINTNEXTLINE(readability-function-size): a table
void add_design_lines(Json& schemas) {
    schemas["DesignLine"] = any_line(
        {"DesignStart", "DesignPoint", "DesignSample", "DesignProgress", "DesignDone",
         "SweepError"});
    const Json host = object_of(
        {{"m1", number(), "mass, kg"},
         {"c1", number(), "damping, N s/m"},
         {"k1", number(), "stiffness, N/m"},
         {"f0", number(), "frequency, Hz"},
         {"damping_ratio", number(), "damping ratio"}});
    schemas["DesignStart"] = line_of(
        "start", {{"version", text(), "version of the program"},
                  {"commit", text(), "commit of the program; empty if unknown"},
                  {"runs_of", whole(), "motions of the first map and of the samples"},
                  {"b_from", number(), "smallest clearance, m"},
                  {"b_to", number(), "largest clearance, m"},
                  {"host", host, "the machine without absorber"},
                  {"request", reference("DesignRequest"), "the request"}});
    schemas["DesignPoint"] = line_of("point", absorber_keys());
    Keys drawn;
    for (const std::string& name : enum_choices<Toleranced>())
        drawn = {drawn, {name + "?", number(), "in SI"}};
    schemas["DesignSample"] = line_of(
        "sample", {{"index", whole(), "number of the sample"},
                   {"values", object_of(drawn), "values drawn"},
                   absorber_keys(),
                   {"regime", or_null(regime_name()),
                    "type of the motion in the worst case; null if it was not measured"},
                   {"verdict", enum_schema<Verdict>(),
                    "its verdict; null without impacts or if it was not measured"}});
    schemas["DesignProgress"] = line_of(
        "progress",
        {{"done", whole(), "absorbers so far"},
         {"runs", whole(), "motions so far"},
         {"runs_of", whole(), "those of the first map and of the samples, or those so far"}});
    const Keys ratios = {
        {"frequency_ratio", number(), "its frequency over that of the host"},
        {"damping_ratio", number(), "its damping ratio c2/(2 sqrt(k2 m2))"}};
    const Json margins = object_of(
        {{"b", margin(), "of the clearance"},
         {"R", margin(), "of the restitution coefficient"},
         {"f0", margin(), "of the host's frequency"},
         {"damping", margin(), "of the host's damping"}});
    const Json best = object_of(
        {absorber_keys(),
         {"regime?", or_null(text()), "type of the motion in the worst case; null without a band"},
         {"impact_speed_max?", number(), "largest |x' - y'| before an impact, m/s"},
         {"impulse_max?", number(), "largest impulse of an impact, N s"},
         {"impacts_per_second?", number(), "most impacts per second"},
         {"margins?", margins, "how far values may be off"},
         {"works_from?", number(),
          "smallest amplitude with at least half of the reduction at the largest one"},
         {"works_to?", number(), "largest such amplitude, as far as tried"},
         {"activation?", or_null(number()),
          "amplitude at which the host reaches the manifold's fold; null for R = 1"}});
    const Json columns = list_of(or_null(number()));
    Keys of_starts;
    for (const Key& objective : objective_keys(columns, ""))
        for (const std::string start : {"worst", "best"})
            of_starts = {
                of_starts,
                {objective.name + "_" + start + "_start?", columns,
                 "objective with the " + start + " start"}};
    const Json response = object_of(
        {{"f", columns, "frequencies, Hz; one null without a band"},
         of_starts,
         {"without", columns, "objective without absorber"},
         {"tuned_mass_damper", columns, "objective with the tuned mass damper"},
         {"impact_speed_max", columns, "largest |x' - y'| before an impact, m/s"},
         {"impulse_max", columns, "largest impulse of an impact, N s"},
         {"impacts_per_second", columns, "most impacts per second"}});
    const Json tolerances = object_of(
        {{"samples", whole(), "number of samples"},
         {"probability", numbers(), "probabilities of the quantiles"},
         objective_keys(
             list_of(or_null(number())),
             "quantiles of the objective's largest value over band and amplitudes"),
         {"regimes", fractions({"regime", or_null(regime_name()), "null: not measured"}),
          "types of the motions in the worst case"},
         {"verdicts",
          fractions({"verdict", enum_schema<Verdict>(), "null: no impacts or not measured"}),
          "verdicts on them"}});
    schemas["DesignDone"] = line_of(
        "done",
        {{"complete", flag(), "false if stopped: best is the best so far, without its details"},
         {"best", best, "the best absorber"},
         {"without", linear({}), "the host without absorber"},
         {"tuned_mass_damper", linear(ratios), "the best one of the same mass for this band"},
         {"den_hartog", linear(ratios), "the closed-form one of the same mass"},
         {"response", response, "over the band, at the largest amplitude"},
         {"sentence", text(), "the result in words"},
         {"tolerances?", tolerances, "of the samples"}});
}

}  // namespace vines::api::document
