#include "api/system_fields.hpp"

#include <map>
#include <numbers>

#include "api/schema/enum_names.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

using S = SystemFields;
const std::map<std::string, SystemNumber> numbers = {
    {"b", &S::b},
    {"R", &S::R},
    {"R_plus", &S::R_plus},
    {"R_minus", &S::R_minus},
    {"epsilon", &S::epsilon},
    {"lambda", &S::lambda},
    {"G", &S::G},
    {"Omega", &S::Omega},
    {"m1", &S::m1},
    {"k1", &S::k1},
    {"f0", &S::f0},
    {"c1", &S::c1},
    {"damping_ratio", &S::damping_ratio},
    {"m2", &S::m2},
    {"mass_ratio", &S::mass_ratio},
    {"F", &S::F},
    {"f", &S::f},
    {"acceleration", &S::acceleration},
    {"gravity", &S::gravity},
    {"inclination", &S::inclination},
    {"friction", &S::friction},
    {"mu", &S::mu},
    {"x0", &S::x0},
    {"x_dot0", &S::x_dot0},
    {"x_velocity0", &S::x_velocity0},
    {"y0", &S::y0},
    {"y_dot0", &S::y_dot0},
    {"y_velocity0", &S::y_velocity0},
};

constexpr double standard_gravity = 9.80665;  // m/s^2

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
                 g = standard_gravity / (omega0 * omega0);
    p.gravity = s.gravity.value_or(s.inclination ? g * elementary::sin(*s.inclination) : 0);
    p.friction =
        s.friction.value_or(s.mu ? *s.mu * g * elementary::cos(s.inclination.value_or(0)) : 0);
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

SystemNumber system_number(const std::string& name) {
    const auto found = numbers.find(name);
    return found == numbers.end() ? nullptr : found->second;
}

SystemFields system_fields(const Json& fields) {
    SystemFields s;
    for (const auto& [name, value] : fields.items())
        if (const SystemNumber number = system_number(name)) s.*number = value.get<double>();
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
    si.m1 = s.m1.value_or(si.m1);
    const double omega0 = 2 * std::numbers::pi * s.f0.value_or(0);
    si.k1 = s.f0 ? si.m1 * omega0 * omega0 : s.k1.value_or(si.k1);
    si.m2 = s.mass_ratio ? *s.mass_ratio * si.m1 : s.m2.value_or(si.m2);
    si.c1 = s.damping_ratio ? 2 * *s.damping_ratio * si.m1 * si.omega0() : s.c1.value_or(si.c1);
    si.f = s.f.value_or(si.f0());
    const double omega = 2 * std::numbers::pi * si.f;
    si.F = s.acceleration ? *s.acceleration / (omega * omega)
                          : s.F.value_or(Parameters{}.G * si.epsilon());
    return si;
}

std::shared_ptr<const Load> ForcingField::load(const SiParameters& si) const {
    const std::lock_guard lock(mutex_);
    if (!last_ || omega0_ != si.omega0() || k1_ != si.k1) {
        last_ = read_load(given_, si);
        omega0_ = si.omega0(), k1_ = si.k1;
    }
    return last_;
}

ResolvedSystem resolve(const SystemFields& s) {
    ResolvedSystem system;
    Parameters& p = system.parameters;
    if (s.is_in_si() && !s.is_reduced()) {
        system.si = si_of(s);
        p.epsilon = system.si->epsilon();
        p.lambda = system.si->lambda();
        p.G = system.si->G();
        p.Omega = system.si->Omega();
    } else {
        p.epsilon = s.epsilon.value_or(p.epsilon);
        p.lambda = s.lambda.value_or(p.lambda);
        p.G = s.G.value_or(p.G);
        p.Omega = s.Omega.value_or(p.Omega);
        // A preset in SI supplies the scale of reduced fields.
        if (s.is_in_si()) system.si = in_si(p, s.m1.value_or(0), s.k1.value_or(0));
    }
    p.b = s.b.value_or(p.b);
    const double R = s.R.value_or(p.R_plus);
    p.R_plus = s.R_plus.value_or(R);
    p.R_minus = s.R_minus.value_or(R);
    p.damping = s.damping;
    resolve_laws(s, system);
    if (s.forcing && system.si) {
        p.load = s.forcing->load(*system.si);
        p.G = system.si->F = 0;
        p.Omega = 1;
        system.si->f = system.si->f0();
    }
    return system;
}

State start_of(const SystemFields& s, const ResolvedSystem& system) {
    auto velocity = [&](std::optional<double> in_tau, std::optional<double> in_si) {
        return in_si && system.si ? *in_si / system.si->omega0() : in_tau.value_or(0);
    };
    const double x = s.x0.value_or(0);
    return {
        .x_dot = velocity(s.x_dot0, s.x_velocity0),
        .x = x,
        .y_dot = velocity(s.y_dot0, s.y_velocity0),
        .y = s.y0.value_or(x + default_state(system.parameters).y)};
}

}  // namespace vines::api
