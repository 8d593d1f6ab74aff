#include "api/request.hpp"

#include <algorithm>
#include <map>

#include "api/presets.hpp"

namespace vines::api {

void refuse(std::vector<FieldError> errors) {
    const std::string detail = errors.size() == 1             ? errors[0].detail
                               : errors.size() >= most_errors ? "the first " + std::to_string(errors.size()) + " faults are listed"
                                                              : std::to_string(errors.size()) + " fields are at fault";
    throw Problem(422, detail, std::move(errors));
}

namespace {

const std::vector<std::string> reduced_names = {"epsilon", "lambda", "G", "Omega"};
const std::vector<std::string> si_names = {"m1", "c1", "k1", "m2", "F", "f"};
// Which SI fields each reduced one follows from.
const std::map<std::string, std::vector<std::string>> si_origin = {
    {"epsilon", {"m2", "m1"}}, {"lambda", {"c1", "k1", "m1", "m2"}}, {"G", {"F", "m1", "m2"}}, {"Omega", {"f", "k1", "m1"}}};

/// Fields that exclude each other: giving one of each side is a fault.
struct Alternative {
    std::vector<std::string> one, other;
    std::string detail;
};
const std::vector<Alternative>& alternatives() {
    static const std::vector<Alternative> list = {
        {reduced_names, si_names, "reduced (epsilon, lambda, G, Omega) and SI (m1, c1, k1, m2, F, f) fields cannot be mixed"},
        {{"R"}, {"R_plus", "R_minus"}, "R stands for both walls and cannot be mixed with R_plus or R_minus"},
        {{"tau_end"}, {"cycles"}, "tau_end and cycles both say how long to run; give one of them"},
    };
    return list;
}

std::vector<std::string> present(const Json& object, const std::vector<std::string>& names) {
    std::vector<std::string> found;
    std::copy_if(names.begin(), names.end(), std::back_inserter(found), [&](const std::string& n) { return object.contains(n); });
    return found;
}

void check_alternatives(const Json& object, std::vector<FieldError>& errors) {
    for (const Alternative& a : alternatives()) {
        if (present(object, a.one).empty() || present(object, a.other).empty()) continue;
        for (const auto& names : {a.one, a.other})
            for (const std::string& name : present(object, names)) errors.push_back({"/" + name, object[name], nullptr, a.detail});
    }
}

const Preset& preset_named(const std::string& name) {
    const auto preset = std::find_if(presets().begin(), presets().end(), [&](const Preset& p) { return p.name == name; });
    if (preset != presets().end()) return *preset;
    Json names = Json::array();
    for (const Preset& p : presets()) names.push_back(p.name);
    refuse({{"/preset", name, names, "there is no preset of this name; GET /v1/presets lists them"}});
}

/// A system in SI from its fields, of which those left out are Table 1's; F and f then follow from the rest.
SiParameters read_si(const Json& fields) {
    SiParameters si;
    si.m1 = fields.value("m1", si.m1);
    si.c1 = fields.value("c1", si.c1);
    si.k1 = fields.value("k1", si.k1);
    si.m2 = fields.value("m2", si.m2);
    si.F = fields.value("F", 0.02 * si.epsilon());
    si.f = fields.value("f", si.f0());
    return si;
}

/// The preset's system restated by the fields that the request speaks in, so that each one given replaces its own value alone.
/// Presets are in SI, or Table 1's: then they leave these fields out. Reduced ones over SI leave m1 and k1, which set the scale.
void restate_system(Json& preset, const Json& given) {
    if (!present(given, si_names).empty()) {
        const SiParameters si = read_si(preset);
        preset.update({{"m1", si.m1}, {"c1", si.c1}, {"k1", si.k1}, {"m2", si.m2}, {"F", si.F}, {"f", si.f}});
    } else if (!present(given, reduced_names).empty() && !present(preset, si_names).empty()) {
        const SiParameters si = read_si(preset);
        for (const std::string& name : si_names) preset.erase(name);
        preset.update({{"m1", si.m1}, {"k1", si.k1}, {"epsilon", si.epsilon()}, {"lambda", si.lambda()}, {"G", si.G()}, {"Omega", si.Omega()}});
    }
}

/// The same for the walls: R of the preset stands for both.
void restate_walls(Json& preset, const Json& given) {
    if (!preset.contains("R") || present(given, {"R_plus", "R_minus"}).empty()) return;
    preset["R_plus"] = preset["R_minus"] = preset["R"];
    preset.erase("R");
}

/// The request's fields over those of its preset, of which only those that the table has are taken.
Json over_preset(const std::vector<Field>& fields, const Json& given) {
    if (!given.contains("preset")) return given;
    Json merged = preset_named(given["preset"]).parameters;
    restate_system(merged, given);
    restate_walls(merged, given);
    // A window that was left to the preset makes no sense in a run of another length.
    if (given.contains("tau_end") || given.contains("cycles"))
        for (const char* name : {"tau_end", "cycles", "window", "windows"}) merged.erase(name);
    for (auto it = merged.begin(); it != merged.end();)
        it = std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.name == it.key(); }) ? std::next(it) : merged.erase(it);
    merged.update(given);
    merged.erase("preset");
    return merged;
}

/// Values by name: the request's, else the table's default.
class Values {
public:
    Values(const std::vector<Field>& fields, const Json& object) : fields_(fields), object_(object) {}
    bool has(const std::string& name) const { return object_.contains(name); }
    double number(const std::string& name) const { return value(name).get<double>(); }
    double number(const std::string& name, double fallback) const { return has(name) ? object_[name].get<double>() : fallback; }
    std::string word(const std::string& name) const { return value(name).get<std::string>(); }
    std::set<std::string> words(const std::string& name) const { return value(name).get<std::set<std::string>>(); }
    bool holds(const std::string& name, const std::string& word) const { return words(name).contains(word); }
    Interval interval(const std::string& name) const { return interval_of(value(name)); }
    std::vector<Interval> intervals(const std::string& name) const {
        std::vector<Interval> list;
        for (const Json& v : value(name)) list.push_back(interval_of(v));
        return list;
    }

private:
    static Interval interval_of(const Json& v) { return {v[0].get<double>(), v[1].get<double>()}; }
    const Json& value(const std::string& name) const {
        if (has(name)) return object_[name];
        const auto has_it = [&](const Field& f) { return f.name == name; };
        const auto own = std::find_if(fields_.begin(), fields_.end(), has_it);
        if (own != fields_.end() && !own->fallback.is_null()) return own->fallback;
        return std::find_if(simulate_fields().begin(), simulate_fields().end(), has_it)->fallback;
    }
    const std::vector<Field>& fields_;
    const Json& object_;
};

/// A core fault is about a reduced field; where that follows from SI fields, it is they that are at fault: those that were given.
std::vector<FieldError> field_errors(const std::vector<Fault>& faults, const Json& object, const Json& given) {
    std::vector<FieldError> errors;
    for (const Fault& f : faults) {
        const auto origin = si_origin.find(f.field);
        const auto names = object.contains(f.field) || origin == si_origin.end() ? std::vector<std::string>{} : present(given, origin->second);
        if (names.empty()) errors.push_back({"/" + f.field, object.contains(f.field) ? object[f.field] : Json(f.value), Json::array({f.minimum, f.maximum}), f.message});
        for (const std::string& name : names)
            errors.push_back({"/" + name, object[name], nullptr, f.field + " = " + Json(f.value).dump() + " follows from the SI fields; " + f.message});
    }
    return errors;
}

System read_system(const Values& v, const Json& object) {
    System system;
    Parameters& p = system.parameters;
    const bool si = !present(object, si_names).empty();
    if (si && present(object, reduced_names).empty()) {
        system.si = read_si(object);
        p.epsilon = system.si->epsilon();
        p.lambda = system.si->lambda();
        p.G = system.si->G();
        p.Omega = system.si->Omega();
    } else {
        p.epsilon = v.number("epsilon");
        p.lambda = v.number("lambda");
        p.G = v.number("G");
        p.Omega = v.number("Omega");
        if (si) system.si = in_si(p, v.number("m1"), v.number("k1"));
    }
    p.b = v.number("b");
    p.R_plus = v.number("R_plus", v.number("R"));
    p.R_minus = v.number("R_minus", v.number("R"));
    p.damping = v.word("damping") == "closed_form" ? Damping::closed_form : Damping::equation_of_motion;
    return system;
}

State read_start(const Values& v, const Parameters& p) {
    return {v.number("x_dot0"), v.number("x0"), v.number("y_dot0"), v.number("y0", default_state(p).y)};
}

/// A window must begin within the run.
void check_window(const std::string& where, const Interval& window, double tau_end, std::vector<FieldError>& errors) {
    if (window.from >= tau_end)
        errors.push_back({where + "/0", window.from, Json::array({0, tau_end}), "the window begins after the run's end, tau_end = " + Json(tau_end).dump()});
}

}  // namespace

Json checked(const std::vector<Field>& fields, const Json& given) {
    std::vector<FieldError> errors = check(fields, given);
    check_alternatives(given, errors);
    if (!errors.empty()) refuse(std::move(errors));
    return over_preset(fields, given);
}

System read_checked_system(const std::vector<Field>& fields, const Json& object, const Json& given) {
    const System system = read_system(Values(fields, object), object);
    const std::vector<FieldError> errors = field_errors(validate(system.parameters, default_state(system.parameters)), object, given);
    if (!errors.empty()) refuse(errors);
    return system;
}

SimulateRequest read_simulate_request(const Json& given) {
    const Json object = checked(simulate_fields(), given);
    const Values v(simulate_fields(), object);

    SimulateRequest r;
    r.system = read_system(v, object);
    const Parameters& p = r.system.parameters;
    r.start = read_start(v, p);

    std::vector<FieldError> errors = field_errors(validate(p, r.start), object, given);
    r.tau_end = v.has("cycles") ? v.number("cycles") * p.cycle() : v.number("tau_end");
    const double cycle = p.cycle(), longest = std::min(longest_run, most_cycles * cycle);
    if (errors.empty() && r.tau_end > longest) {  // of an Omega in its range
        const bool by_cycles = v.has("cycles");
        const double most = by_cycles ? longest / cycle : longest;
        errors.push_back({by_cycles ? "/cycles" : "/tau_end", by_cycles ? object["cycles"] : Json(r.tau_end), Json::array({1e-6, most}),
                          "a run may be as long as tau = 1e7 and 2e6 cycles of 2 pi/Omega: here at most " + Json(most).dump()});
    }
    r.window = v.has("window") ? v.interval("window") : Interval{0, r.tau_end};
    check_window("/window", r.window, r.tau_end, errors);
    r.windows = v.intervals("windows");
    for (std::size_t i = 0; i < r.windows.size(); ++i) check_window("/windows/" + std::to_string(i), r.windows[i], r.tau_end, errors);
    if (!errors.empty()) refuse(std::move(errors));

    r.samples_per_cycle = v.number("samples_per_cycle");
    r.max_points = static_cast<std::size_t>(v.number("max_points"));
    r.max_impacts = static_cast<long>(v.number("max_impacts"));
    r.listed_impacts = static_cast<std::size_t>(r.max_impacts);
    r.include = v.words("include");
    r.estimators = {v.holds("exponents", "qr"), v.holds("exponents", "eigenvalues"), v.holds("exponents", "raw_product"), r.max_points};
    return r;
}

StartedSystem read_started_system(const Json& given) {
    const Json object = checked(sweep_base_fields(), given);
    const Values v(sweep_base_fields(), object);
    StartedSystem s;
    s.system = read_system(v, object);
    s.start = read_start(v, s.system.parameters);
    s.max_impacts = static_cast<long>(v.number("max_impacts"));
    const std::vector<FieldError> errors = field_errors(validate(s.system.parameters, s.start), object, given);
    if (!errors.empty()) refuse(errors);
    return s;
}

ManifoldRequest read_manifold_request(const Json& given) {
    const Json object = checked(manifold_fields(), given);
    const Values v(manifold_fields(), object);
    ManifoldRequest r;
    r.system = read_system(v, object);
    const Parameters& p = r.system.parameters;
    std::vector<FieldError> errors = field_errors(validate(p, default_state(p)), object, given);
    if (p.R_plus != p.R_minus)
        errors.push_back({"/R_minus", p.R_minus, Json::array({p.R_plus, p.R_plus}),
                          "the manifold of two symmetric impacts needs the same restitution coefficient at both walls, here R_plus = " + Json(p.R_plus).dump()});
    if (!errors.empty()) refuse(std::move(errors));
    r.V_max = v.number("V_max", 0);
    r.points = static_cast<std::size_t>(v.number("points"));
    return r;
}

}  // namespace vines::api
