// The core's parameters and initial state from the fields of a request or of a sweep's point.
#include <algorithm>

#include "api/schema/enum_names.hpp"
#include "api/system.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

/// Nullopt if not given or not a table.
std::optional<RestitutionField> restitution_field(const Json& fields, const char* name) {
    if (!fields.contains(name)) return std::nullopt;
    const Json& f = fields[name];
    const bool in_si = f.contains("speed_m_s");
    const Json speed = f.value(in_si ? "speed_m_s" : "speed", Json::array()),
               R = f.value("R", Json::array());
    if (R.empty() || speed.size() != R.size()) return std::nullopt;
    return RestitutionField{
        {speed.get<std::vector<double>>(), R.get<std::vector<double>>()}, in_si};
}

/// Gravity and friction of the ball, and its walls.
void resolve_laws(const SystemFields& s, ResolvedSystem& system) {
    Parameters& p = system.parameters;
    const double omega0 = system.si ? system.si->omega0() : nan,
                 g = standard_gravity / (omega0 * omega0), inclination = s.number("inclination");
    p.gravity = s.number("gravity", s.has("inclination") ? g * elementary::sin(inclination) : 0);
    const double press = s.has("gravity")
                             ? std::sqrt(std::max(0.0, (g - p.gravity) * (g + p.gravity)))
                             : g * elementary::cos(inclination);
    p.friction = s.number("friction", s.has("mu") ? s.number("mu") * press : 0);
    const auto wall = [&](const std::optional<RestitutionField>& own, double& R) {
        const auto& given = own ? own : s.restitution;
        if (!given) return std::shared_ptr<const RestitutionTable>();
        RestitutionTable table = given->table;
        if (given->in_si)
            for (double& w : table.speed) w /= omega0;
        R = table.at(0);
        return std::make_shared<const RestitutionTable>(std::move(table));
    };
    p.table_plus = wall(s.restitution_plus, p.R_plus);
    p.table_minus = wall(s.restitution_minus, p.R_minus);
    if (s.restitution) p.table_minus = p.table_plus;
}

}  // namespace

bool SystemFields::has_any(const std::vector<std::string>& names) const {
    return std::ranges::any_of(names, [this](const std::string& name) { return has(name); });
}

double SystemFields::number(const std::string& name, double fallback) const {
    const auto given = numbers.find(name);
    return given == numbers.end() ? fallback : given->second;
}

SystemFields system_fields(const Json& fields) {
    SystemFields s;
    for (const auto& [name, value] : fields.items())
        if (value.is_number()) s.numbers[name] = value.get<double>();
    s.restitution = restitution_field(fields, "restitution");
    s.restitution_plus = restitution_field(fields, "restitution_plus");
    s.restitution_minus = restitution_field(fields, "restitution_minus");
    if (fields.contains("forcing")) s.forcing = std::make_shared<ForcingField>(fields["forcing"]);
    if (fields.contains("damping"))
        s.damping = enum_value<Damping>(fields["damping"].get<std::string>());
    return s;
}

SiParameters si_of(const SystemFields& s) {
    SiParameters si;
    si.m1 = s.number("m1", si.m1);
    const double omega0 = 2 * std::numbers::pi * s.number("f0");
    si.k1 = s.has("f0") ? si.m1 * omega0 * omega0 : s.number("k1", si.k1);
    si.m2 = s.has("mass_ratio") ? s.number("mass_ratio") * si.m1 : s.number("m2", si.m2);
    si.c1 = s.has("damping_ratio") ? 2 * s.number("damping_ratio") * si.m1 * si.omega0()
                                   : s.number("c1", si.c1);
    si.f = s.number("f", si.f0());
    const double omega = 2 * std::numbers::pi * si.f;
    si.F = s.has("acceleration") ? s.number("acceleration") / (omega * omega)
                                 : s.number("F", Parameters{}.G * si.epsilon());
    return si;
}

ResolvedSystem resolve(const SystemFields& s, bool makes_load) {
    ResolvedSystem system;
    Parameters& p = system.parameters;
    if (s.is_in_si() && !s.is_reduced()) {
        system.si = si_of(s);
        p.epsilon = system.si->epsilon();
        p.lambda = system.si->lambda();
        p.G = system.si->G();
        p.Omega = system.si->Omega();
    } else {
        p.epsilon = s.number("epsilon", p.epsilon);
        p.lambda = s.number("lambda", p.lambda);
        p.G = s.number("G", p.G);
        p.Omega = s.number("Omega", p.Omega);
        // A preset in SI supplies the scale of reduced fields.
        if (s.is_in_si()) system.si = in_si(p, s.number("m1"), s.number("k1"));
    }
    p.b = s.number("b", p.b);
    const double R = s.number("R", p.R_plus);
    p.R_plus = s.number("R_plus", R);
    p.R_minus = s.number("R_minus", R);
    p.damping = s.damping;
    resolve_laws(s, system);
    if (s.forcing && system.si) {
        if (makes_load) p.load = s.forcing->load(*system.si);
        else s.forcing->check(*system.si);
        p.G = system.si->F = 0;
        p.Omega = 1;
        system.si->f = system.si->f0();
    }
    return system;
}

State start_of(const SystemFields& s, const ResolvedSystem& system) {
    const auto velocity = [&](const char* in_tau, const char* in_si) {
        return system.si && s.has(in_si) ? s.number(in_si) / system.si->omega0() : s.number(in_tau);
    };
    const double x = s.number("x0");
    return {
        .x_dot = velocity("x_dot0", "x_velocity0"),
        .x = x,
        .y_dot = velocity("y_dot0", "y_velocity0"),
        .y = s.number("y0", x + default_state(system.parameters).y)};
}

}  // namespace vines::api
