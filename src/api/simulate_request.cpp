// The requests of /v1/simulate and /v1/manifold.
#include <algorithm>
#include <set>

#include "api/simulate.hpp"

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

bool is_as_long_as_load(const MergedFields& l, const Parameters& p) {
    return p.load && p.load->sets_length() && !l.has("cycles") && !l.has("tau_end");
}

/// A base that ends this many times b away has probably an offset in its acceleration.
constexpr double far_away = 1000;

/// Warnings about the length of a load, and about a base that moves far away.
void add_notes_on_load(System& system, double tau_end) {
    const Load& load = *system.parameters.load;
    if (load.sets_length() && tau_end > load.length() * (1 + 1e-12))
        system.notes.push_back(
            "forcing ends at tau = " + Json(load.length()).dump() +
            "; afterwards an acceleration or force is zero, and a displacement stays");
    const double far = load.largest_base_displacement(tau_end);
    if (far > far_away * system.parameters.b)
        system.notes.push_back(
            "the base moves as far as " + Json(far).dump() +
            " m, more than 1000 b: has its acceleration an offset or a mean?");
}

/// The length of the run from tau_end or cycles; an error if it is too long.
double read_tau_end(const MergedFields& l, const Parameters& p, std::vector<FieldError>& errors) {
    const bool by_cycles = l.has("cycles"), by_load = is_as_long_as_load(l, p);
    const double cycle = p.cycle(),
                 tau_end = by_cycles ? l["cycles"].get<double>() * cycle
                           : by_load ? p.load->length()
                                     : l["tau_end"].get<double>(),
                 longest = std::min(longest_run, most_cycles * cycle);
    if (errors.empty() && tau_end > longest) {  // Omega is within its range
        const double most = by_cycles ? longest / cycle : longest;
        errors.push_back(
            {by_cycles ? "/cycles" : "/tau_end", by_cycles ? l.fields["cycles"] : Json(tau_end),
             Json::array({1e-6, most}),
             "a run is limited to tau = 1e7 and 2e6 cycles of 2 pi/Omega: here at most " +
                 Json(most).dump()});
    }
    return tau_end;
}

Parts parts_of(const std::set<std::string>& include) {
    return {
        .series = include.contains("series"),
        .impacts = include.contains("impacts"),
        .exponents = include.contains("exponents"),
        .moduli = include.contains("eigenvalues"),
        .matrices = include.contains("matrices"),
        .section = include.contains("section"),
        .energy = include.contains("energy"),
        .unattached = include.contains("energy"),
        .regime = include.contains("regime"),
        .before_capture = true,
        .manifold = include.contains("manifold")};
}

/// Adds the origin of the run's values among the parameters of the answer. The other fields of a
/// run and its output are lists and objects; their effect shows in the parts of the answer.
void add_origins(std::map<std::string, std::string>& origin, const MergedFields& l) {
    for (const Field& f : l.table)
        if ((f.group == "run" || f.group == "output") &&
            (f.type == FieldType::number || f.type == FieldType::integer ||
             f.type == FieldType::interval))
            origin[f.name] = l.origin(f.name);
    if (l.has("cycles")) origin["tau_end"] = "follows from cycles";
    else origin["cycles"] = "follows from tau_end";
}

/// A component of the perturbation and the start field that it is added to.
struct Component {
    const char *name, *of_start;
    double State::* value;
};
constexpr Component perturbed_components[] = {
    {"x", "x0", &State::x},
    {"x_dot", "x_dot0", &State::x_dot},
    {"y", "y0", &State::y},
    {"y_dot", "y_dot0", &State::y_dot},
};

const std::string at_perturbation = "/perturbation/";

/// Maps an invalid field of the perturbed start to the field of the perturbation. |x - y| <= b is
/// reported for y, or for x if only that is given; a random perturbation is reported by its size.
FieldError error_of(
    const Fault& fault, const Json& given, const Parameters& p, const State& start,
    const State& perturbed) {
    const std::string detail = "the perturbed start is invalid: " + fault.message;
    if (given.contains("size")) return {at_perturbation + "size", given["size"], nullptr, detail};
    const bool by_x = fault.field == "y0" && !given.contains("y");
    const Component& c =
        *std::ranges::find(perturbed_components, by_x ? "x0" : fault.field, &Component::of_start);
    const double from = start.*c.value, low = by_x ? perturbed.y - p.b : fault.minimum,
                 high = by_x ? perturbed.y + p.b : fault.maximum;
    return {
        at_perturbation + c.name, given.value(c.name, 0.0), Json::array({low - from, high - from}),
        detail};
}

/// The perturbation of the initial state, which must be valid; nullopt if not given. Problem 422 if
/// it is invalid.
std::optional<State> read_perturbation(
    const MergedFields& l, const Parameters& p, const State& start) {
    if (!l.has("perturbation")) return std::nullopt;
    const Json& given = l.fields["perturbation"];
    if (!p.has_straight_flights())
        refuse(
            {{"/perturbation", given, nullptr,
              "the distance of two runs is computed for harmonic forcing and a ball without "
              "gravity and friction"}});
    const auto own = present(given, {"x", "x_dot", "y", "y_dot"}),
               random = present(given, {"seed", "size"});
    std::vector<FieldError> errors;
    if (!own.empty() && !random.empty())
        for (const auto& some : {own, random})
            for (const std::string& name : some)
                errors.push_back(
                    {at_perturbation + name, given[name], nullptr,
                     "a perturbation is either x, x_dot, y, y_dot or seed and size"});
    refuse_any(errors);
    if (!random.empty() && !given.contains("size"))
        refuse(at_perturbation + "size", "size, the length of the perturbation, is missing");
    State difference;
    for (const Component& c : perturbed_components) difference.*c.value = given.value(c.name, 0.0);
    if (!random.empty())
        difference = random_difference(
            WithDefaults{find(l.table, "perturbation")->fields, given}["seed"], given["size"]);
    const State perturbed = displaced(start, difference);
    if (length_of(difference_of(perturbed, start)) == 0)
        errors.push_back(
            {"/perturbation", given, nullptr,
             "the perturbed start equals the start: the perturbation must not be zero, nor below "
             "the rounding of the start"});
    for (const Fault& fault : validate(p, perturbed))
        errors.push_back(error_of(fault, given, p, start, perturbed));
    refuse_any(errors);
    return difference;
}

}  // namespace

ExponentOptions read_estimators(const MergedFields& l) {
    const std::set<std::string> names = l["exponents"];
    return {
        .qr = names.contains("qr"),
        .eigenvalues = names.contains("eigenvalues"),
        .raw_product = names.contains("raw_product"),
        .history = l["max_points"]};
}

SimulateRequest read_simulate_request(const Json& given) {
    const MergedFields l = merge_with_preset(simulate_fields(), given);

    SimulateRequest r;
    StartedSystem started = read_started_system(l);
    std::vector<FieldError>& errors = started.errors;
    r.system = std::move(started.system);
    AnalysisRequest& w = r.wanted;
    w.parameters = r.system.parameters;
    w.start = started.start;
    w.max_impacts = started.max_impacts;
    w.tau_end = read_tau_end(l, w.parameters, errors);
    w.window = l.has("window") ? l["window"].get<Interval>() : Interval{0, w.tau_end};
    check_window("/window", w.window, w.tau_end, errors);
    w.windows = l["windows"].get<std::vector<Interval>>();
    for (std::size_t i = 0; i < w.windows.size(); ++i)
        check_window("/windows/" + std::to_string(i), w.windows[i], w.tau_end, errors);
    refuse_any(errors);
    w.perturbation = read_perturbation(l, w.parameters, w.start);

    w.parts = parts_of(l["include"]);
    w.settle_cycles = l["settle_cycles"];
    w.samples_per_cycle = l["samples_per_cycle"];
    w.section_phase = l["section_phase"];
    w.most_points = l["max_points"];
    w.most_listed = static_cast<std::size_t>(w.max_impacts);
    w.estimators = read_estimators(l);
    add_origins(r.system.origin, l);
    if (is_as_long_as_load(l, w.parameters)) r.system.origin["tau_end"] = "the length of forcing";
    if (w.parameters.load) add_notes_on_load(r.system, w.tau_end);
    return r;
}

ManifoldRequest read_manifold_request(const Json& given) {
    const MergedFields l = merge_with_preset(manifold_fields(), given);
    ManifoldRequest r;
    r.system = read_system_alone(l, false);
    const Parameters& p = r.system.parameters;
    if (p.R_plus != p.R_minus)
        refuse(
            {{"/R_minus", p.R_minus, Json::array({p.R_plus, p.R_plus}),
              "the manifold of two symmetric impacts needs the same restitution coefficient at "
              "both walls, here R_plus = " +
                  Json(p.R_plus).dump()}});
    r.V_max = l.has("V_max") ? l["V_max"].get<double>() : 0;
    r.points = l["points"];
    return r;
}

}  // namespace vines::api
