#include "api/request.hpp"

#include <algorithm>

namespace vines::api {

namespace {

/// A window must begin within the run.
void check_window(
    const std::string& where, const Interval& window, double tau_end,
    std::vector<FieldError>& errors) {
    if (window.from >= tau_end)
        errors.push_back(
            {where + "/0", window.from, Json::array({0, tau_end}),
             "the window begins after the run's end, tau_end = " + Json(tau_end).dump()});
}

}  // namespace

SimulateRequest read_simulate_request(const Json& given) {
    const Layered l = layered(simulate_fields(), given);

    SimulateRequest r;
    r.system = read_system(l);
    r.start = read_start(l, r.system);
    const Parameters& p = r.system.parameters;

    std::vector<FieldError> errors = field_errors(validate(p, r.start), l);
    const double cycle = p.cycle(), longest = std::min(longest_run, most_cycles * cycle);
    r.tau_end = l.has("cycles") ? l.number("cycles") * cycle : l.number("tau_end");
    if (errors.empty() && r.tau_end > longest) {  // of an Omega in its range
        const bool by_cycles = l.has("cycles");
        const double most = by_cycles ? longest / cycle : longest;
        errors.push_back(
            {by_cycles ? "/cycles" : "/tau_end", by_cycles ? l.fields["cycles"] : Json(r.tau_end),
             Json::array({1e-6, most}),
             "a run may be as long as tau = 1e7 and 2e6 cycles of 2 pi/Omega: here at most " +
                 Json(most).dump()});
    }
    r.window = l.has("window") ? l.interval("window") : Interval{0, r.tau_end};
    check_window("/window", r.window, r.tau_end, errors);
    r.windows = l.intervals("windows");
    for (std::size_t i = 0; i < r.windows.size(); ++i)
        check_window("/windows/" + std::to_string(i), r.windows[i], r.tau_end, errors);
    if (!errors.empty()) refuse(std::move(errors));

    r.samples_per_cycle = l.number("samples_per_cycle");
    r.section_phase = l.number("section_phase");
    r.max_points = static_cast<std::size_t>(l.number("max_points"));
    r.max_impacts = static_cast<long>(l.number("max_impacts"));
    r.listed_impacts = static_cast<std::size_t>(r.max_impacts);
    r.include = l.words("include");
    const std::set<std::string> estimators = l.words("exponents");
    r.estimators = {
        estimators.contains("qr"), estimators.contains("eigenvalues"),
        estimators.contains("raw_product"), r.max_points};
    for (const char* name : {"tau_end", "cycles"}) r.system.origin[name] = l.origin(name);
    if (l.has("cycles")) r.system.origin["tau_end"] = "follows from cycles";
    else r.system.origin["cycles"] = "follows from tau_end";
    for (const char* name :
         {"window", "samples_per_cycle", "section_phase", "max_points", "max_impacts"})
        r.system.origin[name] = l.origin(name);
    return r;
}

StartedSystem read_started_system(const Json& given) {
    const Layered l = layered(sweep_base_fields(), given);
    StartedSystem s;
    s.system = read_system(l);
    s.start = read_start(l, s.system);
    s.max_impacts = static_cast<long>(l.number("max_impacts"));
    const std::vector<FieldError> errors = field_errors(validate(s.system.parameters, s.start), l);
    if (!errors.empty()) refuse(errors);
    return s;
}

ManifoldRequest read_manifold_request(const Json& given) {
    const Layered l = layered(manifold_fields(), given);
    ManifoldRequest r;
    r.system = read_system_alone(l, false);
    const Parameters& p = r.system.parameters;
    if (p.R_plus != p.R_minus)
        refuse(
            {{"/R_minus", p.R_minus, Json::array({p.R_plus, p.R_plus}),
              "the manifold of two symmetric impacts needs the same restitution coefficient at "
              "both walls, here R_plus = " +
                  Json(p.R_plus).dump()}});
    r.V_max = l.number("V_max", 0);
    r.points = static_cast<std::size_t>(l.number("points"));
    return r;
}

}  // namespace vines::api
