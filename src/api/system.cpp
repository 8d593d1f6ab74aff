#include "api/system.hpp"

#include <algorithm>

#include "api/properties.hpp"

namespace vines::api {

namespace {

constexpr std::size_t most_table_points = 1000;

/// The fields from which each field of the core follows if it is not given.
const std::map<std::string, std::vector<std::string>> sources = {
    {"epsilon", {"m2", "mass_ratio", "m1"}},
    {"lambda", {"c1", "damping_ratio", "k1", "f0", "m1", "m2", "mass_ratio"}},
    {"G", {"F", "acceleration", "m1", "m2", "mass_ratio"}},
    {"Omega", {"f", "k1", "f0", "m1"}},
    {"gravity", {"inclination"}},
    {"friction", {"mu"}},
    {"x_dot0", {"x_velocity0"}},
    {"y_dot0", {"y_velocity0"}}};

/// The given fields that `name` follows from. With f0, Omega = f/f0 is independent of m1.
std::vector<std::string> sources_of(const std::string& name, const Json& fields) {
    std::vector<std::string> names = present(fields, sources.at(name));
    if (name == "Omega" && fields.contains("f0")) std::erase(names, "m1");
    return names;
}

/// Checks that a system in SI is complete. f can be omitted if F = 0.
void check_si_is_whole(const MergedFields& l, bool forcing_fitted) {
    std::vector<FieldError> errors;
    const bool loaded = l.fields.contains("forcing"),
               unforced = loaded || l.fields.value("F", 1.0) == 0 ||
                          l.fields.value("acceleration", 1.0) == 0;
    for (const auto& group : si_groups) {
        if (!present(l.fields, group).empty() || (group[0] == "f" && unforced) ||
            (group[0] == "F" && (forcing_fitted || loaded)))
            continue;
        errors.push_back(
            {"/" + group[0], nullptr, nullptr,
             group[0] + (group.size() > 1 ? " (or " + group[1] + ")" : "") +
                 " is missing: a system in SI needs m1, c1 or damping_ratio, k1 or f0, m2 or "
                 "mass_ratio, F or acceleration, and f, or a preset for the rest"});
    }
    refuse_any(errors);
}

/// Errors of a table of R.
void check_restitution(const MergedFields& l, const std::string& name, bool si) {
    if (!l.has(name)) return;
    const Json& table = l.fields[name];
    std::vector<FieldError> errors;
    const auto fail = [&](const std::string& where, const Json& value, const Json& range,
                          const std::string& detail) {
        errors.push_back({"/" + name + where, value, range, name + " " + detail});
    };
    if (table.contains("speed") == table.contains("speed_m_s"))
        fail("", nullptr, nullptr, "needs either speed or speed_m_s");
    if (!table.contains("R")) fail("/R", nullptr, nullptr, "needs R");
    refuse_any(errors);
    const std::string column = table.contains("speed") ? "speed" : "speed_m_s";
    const Json &speed = table[column], &R = table["R"];
    if (column == "speed_m_s" && !si)
        fail("/speed_m_s", nullptr, nullptr, "in m/s needs a system in SI (m1, k1 or f0, ...)");
    if (speed.empty() || speed.size() > most_table_points)
        fail(
            "/" + column, speed.size(), Json::array({1, most_table_points}),
            "has too few or too many points");
    if (speed.size() != R.size())
        fail("/R", R.size(), speed.size(), "needs as many values of R as speeds");
    refuse_any(errors);
    const std::size_t wrong = speed[0] >= 0 ? first_not_ascending(speed) : 0;
    if (wrong < speed.size())
        fail(
            "/" + column + "/" + std::to_string(wrong), speed[wrong], nullptr,
            "needs speeds >= 0 in ascending order");
    for (std::size_t i = 0; i < R.size() && errors.empty(); ++i)
        if (const double r = R[i].get<double>(); !(r >= 0 && r <= 1))
            fail("/R/" + std::to_string(i), R[i], Json::array({0, 1}), "needs R in [0, 1]");
    refuse_any(errors);
}

/// Checks the laws of the ball and of its walls as far as the core does not.
void check_laws(const MergedFields& l, bool si) {
    std::vector<FieldError> errors;
    for (const auto& [name, reduced] :
         {std::pair{"inclination", "gravity"}, std::pair{"mu", "friction"}})
        if (l.has(name) && !si)
            errors.push_back(
                {std::string("/") + name, l.fields[name], nullptr,
                 std::string(name) +
                     " needs a system in SI (m1, k1 or f0, ...); without one give " + reduced +
                     ", in m"});
    refuse_any(errors);
    for (const char* name : {"restitution", "restitution_plus", "restitution_minus"})
        check_restitution(l, name, si);
}

/// Refuses a gravity larger than that of a vertical track, with which mu has no meaning.
void check_gravity(const MergedFields& l, const std::optional<SiParameters>& si) {
    if (!l.has("mu") || !l.has("gravity") || !si) return;
    const double most = standard_gravity / (si->omega0() * si->omega0());
    if (std::abs(l.fields["gravity"].get<double>()) > most)
        refuse(
            {{"/gravity", l.fields["gravity"], Json::array({-most, most}),
              "with mu, gravity is g sin(inclination)/omega0^2; for another one give friction"}});
}

/// A note if R w falls with the speed w: a faster impact then leaves more slowly.
void note_falling_restitution(const Parameters& p, Warnings& notes) {
    for (const auto& [table, wall] :
         {std::pair{p.table_plus, "plus"}, std::pair{p.table_minus, "minus"}}) {
        if (!table) continue;
        for (std::size_t i = 1; i < table->speed.size(); ++i) {
            const double before = table->speed[i - 1], w = table->speed[i];
            // d(R w)/dw is linear between two points.
            const double slope = (table->R[i] - table->R[i - 1]) / (w - before);
            if (std::min(table->R[i - 1] + before * slope, table->R[i] + w * slope) >= 0) continue;
            notes.push_back(
                std::string("R times the speed falls between two speeds of the wall ") + wall +
                ", " + Json(before).dump() + " and " + Json(w).dump() +
                " m per unit of tau: a faster impact leaves more slowly there");
            break;
        }
    }
}

/// The origin of each value of a system.
std::map<std::string, std::string> origins_of(const MergedFields& l, const System& s) {
    std::map<std::string, std::string> origin;
    auto follows = [&](const std::string& name) {
        return "follows from " + joined(sources_of(name, l.fields));
    };
    const bool reduced = !present(l.fields, reduced_names).empty();
    for (const std::string& name : reduced_names)
        origin[name] = s.si && !reduced ? follows(name) : l.origin(name);
    for (const char* name : {"b", "damping"}) origin[name] = l.origin(name);
    for (const std::string name : {"R_plus", "R_minus"}) {
        const std::string table = "restitution" + name.substr(1);
        const auto own = present(l.fields, {name, table, "restitution", "R"});
        origin[name] = own.empty()        ? l.origin("R")
                       : own[0][0] == 'r' ? "follows from " + own[0]
                                          : l.origin(own[0]);
    }
    for (const char* name : {"gravity", "friction"})
        origin[name] = present(l.fields, sources.at(name)).empty() ? l.origin(name) : follows(name);
    if (!s.si) return origin;
    for (const auto& group : si_groups) {
        const bool other = group.size() > 1 && l.fields.contains(group[1]);
        origin[group[0]] =
            other && group[0] == "F" ? "follows from acceleration, f"
            : other
                ? "follows from " + group[1] + ", m1" +
                      (group[0] == "c1" ? ", " + std::string(l.fields.contains("f0") ? "f0" : "k1")
                                        : "")
            : l.fields.contains(group[0]) ? l.origin(group[0])
            : reduced                     ? "follows from the reduced fields"
            : group[0] == "f"             ? "the natural frequency, since F = 0"
                                          : "default";
    }
    return origin;
}

/// Warnings about assumptions on the system that a user might not expect.
Warnings notes_on(const MergedFields& l, const System& s) {
    Warnings notes;
    const Parameters& p = s.parameters;
    if (l.dropped.contains("damping") && l["damping"] != l.dropped["damping"])
        notes.push_back(
            "the system is not that of preset " + l.preset + ": its damping is " +
            l["damping"].get<std::string>() + ", not the preset's " +
            l.dropped["damping"].get<std::string>());
    note_falling_restitution(p, notes);
    if (!s.si || present(l.given, si_names).empty()) return notes;
    std::vector<std::string> taken, assumed;
    const Json si = describe(properties::si, *s.si);
    for (const auto& group : si_groups)
        if (present(l.given, group).empty() && l.fields.contains(group[0]))
            taken.push_back(group[0] + " = " + si[group[0]].dump());
    // b and R belong to the system, too.
    auto cavity = [&](const std::string& text, const std::vector<std::string>& names) {
        if (present(l.given, names).empty())
            (present(l.fields, names).empty() ? assumed : taken).push_back(text);
    };
    cavity("b = " + Json(p.b).dump(), {"b"});
    const bool tables =
        !present(l.given, {"restitution", "restitution_plus", "restitution_minus"}).empty();
    // An identification estimates R.
    if (!tables && !find(l.table, "R")->fallback.is_null())
        cavity("R = " + Json(p.R_plus).dump(), {"R", "R_plus", "R_minus"});
    if (!taken.empty() && !l.preset.empty())
        notes.push_back("not given, and taken from preset " + l.preset + ": " + joined(taken));
    if (!assumed.empty())
        notes.push_back("not given, and assumed as in Table 1 of the paper: " + joined(assumed));
    if (p.damping == Damping::closed_form)
        notes.push_back(
            "damping is closed_form (" + l.origin("damping") +
            "): zeta = " + Json(p.zeta()).dump() + " is twice the damping ratio c1/(2 m1 omega0)");
    return notes;
}

/// Maps the core's faults to the given fields; a reduced parameter can follow from several.
std::vector<FieldError> field_errors(const std::vector<Fault>& faults, const MergedFields& l) {
    std::vector<FieldError> errors;
    for (const Fault& f : faults) {
        const auto source = sources.find(f.field);
        const auto names = l.fields.contains(f.field) || source == sources.end()
                               ? std::vector<std::string>{}
                               : sources_of(f.field, l.given);
        if (names.empty())
            errors.push_back(
                {"/" + f.field, l.fields.contains(f.field) ? l.fields[f.field] : Json(f.value),
                 Json::array({f.minimum, f.maximum}), f.message});
        for (const std::string& name : names)
            errors.push_back(
                {"/" + name, l.given[name], nullptr,
                 f.field + " = " + Json(f.value).dump() + " follows from it; " + f.message});
    }
    return errors;
}

/// Does not check the core's ranges.
System read_system(const MergedFields& l, bool forcing_fitted, bool makes_load = true) {
    const bool si = !present(l.fields, si_names).empty();
    check_laws(l, si);
    if (l.has("forcing") && !si)
        refuse("/forcing", "forcing is in SI and needs a system in SI (m1, k1 or f0, ...)");
    const SystemFields fields = system_fields(l.fields);
    if (fields.is_in_si() && !fields.is_reduced()) check_si_is_whole(l, forcing_fitted);
    System system{resolve(fields, makes_load)};
    check_gravity(l, system.si);
    system.origin = origins_of(l, system);
    system.notes = notes_on(l, system);
    if (!system.parameters.load) return system;
    system.load_kind = l.fields["forcing"].value("kind", "record");
    for (const char* name : {"G", "Omega", "F", "f"}) system.origin[name] = "replaced by forcing";
    return system;
}

/// Warnings go to the system's notes.
State read_start(const MergedFields& l, System& system) {
    for (const char* name : {"x0", "x_dot0", "y0", "y_dot0"}) system.origin[name] = l.origin(name);
    if (l.has("x0") && !l.has("y0")) system.origin["y0"] = "follows from x0";
    std::vector<FieldError> errors;
    auto velocity = [&](const std::string& in_tau, const std::string& in_SI) {
        if (l.has(in_SI) && !system.si)
            errors.push_back(
                {"/" + in_SI, l.fields[in_SI], nullptr,
                 in_SI +
                     " is in m/s and needs a system in SI (m1, k1 or f0, ...); without one give " +
                     in_tau + ", in m per unit of tau"});
        else if (l.has(in_SI)) system.origin[in_tau] = "follows from " + in_SI;
        else if (const double value = l[in_tau]; system.si && value != 0 && l.has(in_tau))
            system.notes.push_back(
                in_tau + " = " + Json(value).dump() + " is in m per unit of tau, here " +
                Json(value * system.si->omega0()).dump() + " m/s; " + in_SI + " is in m/s");
    };
    velocity("x_dot0", "x_velocity0");
    velocity("y_dot0", "y_velocity0");
    refuse_any(errors);
    return start_of(system_fields(l.fields), system);
}

}  // namespace

std::size_t first_not_ascending(const Json& list) {
    std::size_t i = 1;
    while (i < list.size() && list[i].get<double>() > list[i - 1].get<double>()) ++i;
    return i;
}

System read_system_alone(const MergedFields& l, bool forcing_fitted) {
    const System system = read_system(l, forcing_fitted);
    const Parameters& p = system.parameters;
    refuse_any(field_errors(validate(p, default_state(p)), l));
    return system;
}

StartedSystem read_started_system(const MergedFields& l, bool makes_load) {
    StartedSystem s;
    s.system = read_system(l, false, makes_load);
    s.start = read_start(l, s.system);
    s.max_impacts = l["max_impacts"];
    s.errors = field_errors(validate(s.system.parameters, s.start), l);
    return s;
}

StartedSystem read_started_system(const Json& given, bool makes_load) {
    return read_started_system(merge_with_preset(sweep_base_fields(), given), makes_load);
}

std::vector<FieldError> faults_of_base(const Json& given) {
    try {
        return read_started_system(given).errors;
    } catch (const Problem& problem) {
        return problem.errors;
    }
}

}  // namespace vines::api
