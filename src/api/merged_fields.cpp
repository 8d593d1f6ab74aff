// The preset is restated in the kind of fields that the request uses, SI or reduced; its fields
// that do not apply to the request's system or motion are dropped; the request's fields replace the
// rest.
#include <algorithm>
#include <iterator>
#include <numbers>
#include <tuple>

#include "api/presets.hpp"
#include "api/properties.hpp"
#include "api/system.hpp"

namespace vines::api {

const std::vector<std::string> reduced_names = {"epsilon", "lambda", "G", "Omega"};
const std::vector<std::vector<std::string>> si_groups = {
    {"m1"}, {"c1", "damping_ratio"}, {"k1", "f0"}, {"m2", "mass_ratio"}, {"F", "acceleration"},
    {"f"}};
const std::vector<std::string> si_names = [] {
    std::vector<std::string> names;
    for (const auto& group : si_groups) names.insert(names.end(), group.begin(), group.end());
    return names;
}();

std::vector<std::string> present(const Json& object, const std::vector<std::string>& names) {
    std::vector<std::string> found;
    std::ranges::copy_if(
        names, std::back_inserter(found), [&](const auto& name) { return object.contains(name); });
    return found;
}

namespace {

/// Masses, spring and damper. Changing one drops a preset's damping.
const std::vector<std::string> oscillator_fields = {
    "epsilon", "lambda", "m1", "c1", "damping_ratio", "k1", "f0", "m2", "mass_ratio"};
/// Two groups of fields that exclude each other.
struct Alternative {
    std::vector<std::string> one, other;
    std::string detail;
};
const std::vector<Alternative> alternatives = {
    {reduced_names, si_names,
     "reduced (epsilon, lambda, G, Omega) and SI (m1, c1, k1, m2, F, f; damping_ratio, f0, "
     "mass_ratio, acceleration) fields cannot be mixed"},
    {{"R"},
     {"R_plus", "R_minus"},
     "R stands for both walls and cannot be mixed with R_plus or R_minus"},
    {{"R", "R_plus", "R_minus", "restitution_plus", "restitution_minus"},
     {"restitution"},
     "restitution is R of both walls as a function of the speed; give no other R"},
    {{"R", "R_plus"}, {"restitution_plus"}, "R_plus and restitution_plus are of the same wall"},
    {{"R", "R_minus"}, {"restitution_minus"}, "R_minus and restitution_minus are of the same wall"},
    {{"F", "acceleration", "f", "G", "Omega"},
     {"forcing"},
     "forcing replaces F and f; give one of them"},
    {{"F"},
     {"acceleration"},
     "acceleration stands for F = acceleration/(2 pi f)^2; give one of them"},
    {{"gravity"},
     {"inclination"},
     "inclination stands for gravity = g sin(inclination)/omega0^2; give one of them"},
    {{"friction"},
     {"mu"},
     "mu stands for friction = mu g cos(inclination)/omega0^2; give one of them"},
    {{"tau_end"}, {"cycles"}, "tau_end and cycles both say how long to run; give one of them"},
    {{"k1"}, {"f0"}, "f0 stands for k1 = m1 (2 pi f0)^2; give one of them"},
    {{"c1"},
     {"damping_ratio"},
     "damping_ratio stands for c1 = 2 damping_ratio m1 omega0; give one of them"},
    {{"m2"}, {"mass_ratio"}, "mass_ratio stands for m2 = mass_ratio m1; give one of them"},
    {{"x_dot0"},
     {"x_velocity0"},
     "x_dot0 (m per unit of tau) and x_velocity0 (m/s) are the same; give one of them"},
    {{"y_dot0"},
     {"y_velocity0"},
     "y_dot0 (m per unit of tau) and y_velocity0 (m/s) are the same; give one of them"},
};

void check_alternatives(const Json& object, std::vector<FieldError>& errors) {
    for (const Alternative& a : alternatives) {
        if (present(object, a.one).empty() || present(object, a.other).empty()) continue;
        for (const auto& names : {a.one, a.other})
            for (const std::string& name : present(object, names))
                errors.push_back({"/" + name, object[name], nullptr, a.detail});
    }
}

const Preset& preset_named(const std::string& name) {
    const auto preset = std::ranges::find(presets(), name, &Preset::name);
    if (preset != presets().end()) return *preset;
    refuse(
        {{"/preset", name, texts_of(presets(), &Preset::name),
          "there is no preset of this name; GET /v1/presets lists them"}});
}

/// Restates the preset's system in the kind of fields that the request uses, so that each given
/// field replaces only its own value. A preset is in SI or has the values of Table 1, which are
/// omitted from it. Reduced fields over SI keep m1 and k1, which set the scale.
void restate_system(Json& preset, const Json& given) {
    if (!present(given, si_names).empty()) {
        const SiParameters si = si_of(system_fields(preset));
        const double omega = 2 * std::numbers::pi * si.f;
        const Json others = {
            {"c1", si.damping_ratio()},
            {"k1", si.f0()},
            {"m2", si.epsilon()},
            {"F", si.F * omega * omega}};
        preset.update(describe(properties::si, si));
        if (preset.contains("forcing"))
            for (const char* name : {"F", "f"}) preset.erase(name);
        // A value that the request does not give stays as the preset states it.
        for (const auto& group : si_groups) {
            if (group.size() == 1) continue;
            const bool by_other = given.contains(group[1]) ||
                                  (!given.contains(group[0]) && preset.contains(group[1]));
            if (by_other && !preset.contains(group[1])) preset[group[1]] = others[group[0]];
            preset.erase(by_other ? group[0] : group[1]);
        }
    } else if (!present(given, reduced_names).empty()) {
        const SiParameters si = si_of(system_fields(preset));
        const bool in_si = !present(preset, si_names).empty();
        for (const std::string& name : si_names) preset.erase(name);
        if (in_si) preset.update({{"m1", si.m1}, {"k1", si.k1}});
        preset.update(
            {{"epsilon", si.epsilon()},
             {"lambda", si.lambda()},
             {"G", si.G()},
             {"Omega", si.Omega()}});
        if (preset.contains("forcing"))
            for (const char* name : {"G", "Omega"}) preset.erase(name);
    }
}

/// Splits a preset's R into R_plus and R_minus if the request says something about one wall.
void split_walls(Json& preset, const Json& given) {
    if (present(given, {"R_plus", "R_minus", "restitution_plus", "restitution_minus"}).empty())
        return;
    for (const std::string& law : present(preset, {"R", "restitution"})) {
        preset[law + "_plus"] = preset[law + "_minus"] = preset[law];
        preset.erase(law);
    }
}

/// Removes from a preset the fields that the request's fields exclude, except those of the system,
/// which is restated.
void drop_excluded(Json& preset, const Json& given) {
    for (const Alternative& a : alternatives) {
        if (a.one == reduced_names) continue;
        for (const auto& [by, names] : {std::tie(a.one, a.other), std::tie(a.other, a.one)})
            if (!present(given, by).empty())
                for (const std::string& name : names) preset.erase(name);
    }
}

/// Removes from a preset the fields that do not apply to another system or run, and returns them.
Json drop_inapplicable_fields(Json& preset, const FieldTable& table, const Json& given) {
    Json dropped = Json::object();
    auto drop = [&](const char* name) {
        if (!preset.contains(name)) return;
        if (!given.contains(name)) dropped[name] = preset[name];
        preset.erase(name);
    };
    auto replaced = [&](const std::string& name) {
        return given.contains(name) && (!preset.contains(name) || preset[name] != given[name]);
    };
    const bool another_system = std::ranges::any_of(oscillator_fields, replaced);
    const bool another_run = std::ranges::any_of(table, [&](const Field& f) {
        const bool of_the_motion = is_of_system(f) || f.group == "laws" || f.group == "load" ||
                                   f.group == "start" || f.name == "tau_end" || f.name == "cycles";
        return of_the_motion && f.name != "preset" && replaced(f.name);
    });
    if (another_system) drop("damping");
    if (another_run)
        for (const char* name : {"window", "windows"}) drop(name);
    return dropped;
}

}  // namespace

std::string MergedFields::origin(const std::string& name) const {
    return given.contains(name) ? "given" : fields.contains(name) ? "preset " + preset : "default";
}

const Json& MergedFields::operator[](const std::string& name) const {
    if (has(name)) return fields[name];
    const Field* own = find(table, name);
    return own && !own->fallback.is_null() ? own->fallback
                                           : find(simulate_fields(), name)->fallback;
}

MergedFields merge_with_preset(const FieldTable& table, const Json& given) {
    std::vector<FieldError> errors = check(table, given);
    check_alternatives(given, errors);
    refuse_any(errors);
    if (!given.contains("preset")) return {table, given, given, "", Json::object()};
    Json merged = preset_named(given["preset"]).parameters;
    restate_system(merged, given);
    split_walls(merged, given);
    drop_excluded(merged, given);
    Json dropped = drop_inapplicable_fields(merged, table, given);
    for (auto it = merged.begin(); it != merged.end();)  // only fields of the table
        it = find(table, it.key()) ? std::next(it) : merged.erase(it);
    merged.update(given);
    merged.erase("preset");
    return {table, given, std::move(merged), given["preset"], std::move(dropped)};
}

}  // namespace vines::api
