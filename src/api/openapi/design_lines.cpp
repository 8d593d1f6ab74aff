// The lines of the response of /v1/design.
#include <algorithm>

#include "api/openapi/parts.hpp"

namespace vines::api::document {

namespace {

const std::vector<std::string>& objectives() { return find(design_fields(), "objective")->choices; }

/// The objective's value, whose key is its name.
Keys objective_keys() {
    Keys keys;
    for (const std::string& name : objectives())
        keys.push_back(optional(
            {name, or_null(number()),
             "largest value over the band, m, m/s, m/s^2 or s; null if a motion has too many "
             "impacts"}));
    return keys;
}

Keys absorber_keys() {
    return Keys{
               {"b", number(), "clearance, m"},
               {"R", number(), "restitution coefficient of both walls"},
               {"m2", number(), "mass of the ball, kg"}} +
           objective_keys() +
           Keys{
               {"f", or_null(number()), "frequency of the worst case, Hz; null without a band"},
               optional({"acceleration", number(), "amplitude of the base there, m/s^2"}),
               optional({"F", number(), "the same as a displacement, m"}),
               optional({"load_factor", number(), "with forcing: factor on the load"}),
               optional({"initial_velocity", number(), "that of m1, m/s"})};
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
        objective_keys() +
        Keys{{"f", or_null(number()), "frequency of the largest value, Hz; null without a band"}} +
        more);
}

Keys response_keys() {
    const Json columns = list_of(or_null(number()));
    Keys response = {{"f", columns, "frequencies, Hz; one null without a band"}};
    for (const std::string& name : objectives())
        for (const std::string start : {"worst", "best"})
            response.push_back(optional(
                {name + "_" + start + "_start", columns,
                 "objective with the " + start + " start"}));
    return response + Keys{
                          {"without", columns, "objective without absorber"},
                          {"tuned_mass_damper", columns, "objective with the tuned mass damper"},
                          {"impact_speed_max", columns, "largest |x' - y'| before an impact, m/s"},
                          {"impulse_max", columns, "largest impulse of an impact, N s"},
                          {"impacts_per_second", columns, "most impacts per second"}};
}

/// The keys of the best absorber, with the details that follow the search.
Keys best_keys() {
    const Keys details = {
        optional(
            {"regime", or_null(text()),
             "type of the motion in the worst case; null without a band"}),
        optional({"impact_speed_max", number(), "largest |x' - y'| before an impact, m/s"}),
        optional({"impulse_max", number(), "largest impulse of an impact, N s"}),
        optional({"impacts_per_second", number(), "most impacts per second"}),
        optional(
            {"margins",
             object_of(
                 {{"b", margin(), "of the clearance"},
                  {"R", margin(), "of the restitution coefficient"},
                  {"f0", margin(), "of the host's frequency"},
                  {"damping", margin(), "of the host's damping"}}),
             "how far values may be off"}),
        optional(
            {"works_from", number(),
             "smallest amplitude with at least half of the reduction at the largest one"}),
        optional({"works_to", number(), "largest such amplitude, as far as tried"}),
        optional(
            {"activation", or_null(number()),
             "amplitude at which the host reaches the manifold's fold; null for R = 1"})};
    Keys best = absorber_keys();
    for (const Key& key : details)
        if (std::ranges::find(best, key.name, &Key::name) == best.end()) best.push_back(key);
    return best;
}

Keys toleranced_keys() {
    Keys keys;
    for (const std::string& name : enum_choices<Toleranced>())
        keys.push_back(optional({name, number(), "in SI"}));
    return keys;
}

Json fractions(const Key& value) {
    return list_of(object_of(
        {value,
         {"samples", whole(), "number of samples"},
         {"fraction", number(), "fraction of the samples"},
         {"interval", interval(), "95 % interval of its probability"}}));
}

Keys tolerance_keys() {
    Keys keys = {
        {"samples", whole(), "number of samples"},
        {"probability", numbers(), "probabilities of the quantiles"}};
    for (Key key : objective_keys()) {
        key.schema = list_of(std::move(key.schema));
        key.description = "quantiles of the objective's largest value over band and amplitudes";
        keys.push_back(std::move(key));
    }
    return keys +
           Keys{
               {"regimes", fractions({"regime", or_null(regime_name()), "null: not measured"}),
                "types of the motions in the worst case"},
               {"verdicts",
                fractions({"verdict", enum_schema<Verdict>(), "null: no impacts or not measured"}),
                "verdicts on them"}};
}

}  // namespace

void add_design_lines(Json& schemas) {
    schemas["DesignLine"] = by_type(
        {{"start", "DesignStart"},
         {"point", "DesignPoint"},
         {"sample", "DesignSample"},
         {"progress", "DesignProgress"},
         {"done", "DesignDone"},
         {"error", "SweepError"}});
    schemas["DesignStart"] = line_of(
        "start", {{"version", text(), "version of the program"},
                  {"commit", text(), "commit of the program; empty if unknown"},
                  {"runs_of", whole(), "motions of the first map and of the samples"},
                  {"b_from", number(), "smallest clearance, m"},
                  {"b_to", number(), "largest clearance, m"},
                  {"host",
                   object_of(
                       {{"m1", number(), "mass, kg"},
                        {"c1", number(), "damping, N s/m"},
                        {"k1", number(), "stiffness, N/m"},
                        {"f0", number(), "frequency, Hz"},
                        {"damping_ratio", number(), "damping ratio"}}),
                   "the machine without absorber"},
                  {"request", reference("DesignRequest"), "the request"}});
    schemas["DesignPoint"] = line_of("point", absorber_keys());
    schemas["DesignSample"] = line_of(
        "sample",
        Keys{
            {"index", whole(), "number of the sample"},
            {"values", object_of(toleranced_keys()), "values drawn"}} +
            absorber_keys() +
            Keys{
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
    schemas["DesignDone"] = line_of(
        "done",
        {{"complete", flag(), "false if stopped: best is the best so far, without its details"},
         {"best", object_of(best_keys()), "the best absorber"},
         {"without", linear({}), "the host without absorber"},
         {"tuned_mass_damper", linear(ratios), "the best one of the same mass for this band"},
         {"den_hartog", linear(ratios), "the closed-form one of the same mass"},
         {"response", object_of(response_keys()), "over the band, at the largest amplitude"},
         {"sentence", text(), "the result in words"},
         optional({"tolerances", object_of(tolerance_keys()), "of the samples"})});
}

}  // namespace vines::api::document
