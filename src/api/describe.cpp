#include "api/describe.hpp"

#include <cmath>

#include "api/answer_json.hpp"
#include "api/columns.hpp"
#include "api/schema/enum_names.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

Json describe_system(const System& system) {
    const Parameters& p = system.parameters;
    Json j = object(
        {{"epsilon", p.epsilon},
         {"lambda", p.lambda},
         {"G", p.G},
         {"Omega", p.Omega},
         {"R_plus", p.R_plus},
         {"R_minus", p.R_minus},
         {"b", p.b},
         {"damping", enum_json(p.damping)},
         {"origin", system.origin}});
    if (system.si) append(j, {{"si", fields_of(*system.si)}});
    return j;
}

Json describe_derived(const System& system) {
    const Parameters& p = system.parameters;
    const double zeta = p.zeta();
    Json j = object(
        {{"zeta", zeta},
         {"omega_d", zeta < 1 ? Json(std::sqrt(1 - zeta * zeta)) : Json(nullptr)},
         {"A", p.A()},
         {"phi", p.phi()},
         {"cycle", p.cycle()}});
    if (system.si) {
        const SiParameters& si = *system.si;
        append(
            j, {{"omega0", si.omega0()},
                {"f0", si.f0()},
                {"damping_ratio", si.damping_ratio()},
                {"mass_ratio", si.epsilon()},
                {"cycle_s", 1 / si.f}});
    }
    return j;
}

Json describe_sections(const Sections& s) {
    Json stroboscopic = object({{quantity.tau.name, column(s.tau)}});
    stroboscopic.update(describe(state_columns, s.states));
    return object(
        {{"impact", describe(impact_section_columns, s.impact)},
         {"stroboscopic", std::move(stroboscopic)}});
}

Json describe_energy(const EnergyResult& e) {
    const EnergyBalance& b = e.balance;
    Json j = object(
        {{"window", {b.window.from, b.window.to}},
         {"input", b.input},
         {"damper", b.damper},
         {"impacts", b.impacts},
         {"stored", b.stored},
         {"residual", b.residual},
         {"share_impacts", or_null(b.share_impacts)},
         {"at_start", b.at_start},
         {"at_end", b.at_end},
         {"rms", b.rms},
         {"peak", b.peak},
         {"without_absorber", object(
                                  {{"rms", e.unattached->rms},
                                   {"peak", e.unattached->peak},
                                   {"amplitude", or_null(e.unattached->amplitude)}})},
         {"rms_ratio", or_null(e.rms_ratio)},
         {"peak_ratio", or_null(e.peak_ratio)}});
    if (!e.decay) return j;
    auto moments = [](const DecayTimes& m) {
        return Json{{"tau_half", or_null(m.half)}, {"tau_tenth", or_null(m.tenth)}};
    };
    j["decay"] = moments(e.decay->with_absorber);
    j["decay"]["without_absorber"] = moments(e.decay->without);
    return j;
}

Json describe_manifold(const Manifold& m) {
    auto point = [](const ManifoldPoint& of) { return Json{{"C", of.C}, {"V", of.V}}; };
    const bool breaks = m.symmetry_breaking.has_value();
    return object(
        {{"R", m.R},
         {"Omega", m.Omega},
         {"b", m.b},
         {"fold", point(m.fold)},
         {"activation_amplitude", m.fold.C},
         {"symmetry_breaking", breaks ? point(*m.symmetry_breaking) : Json(nullptr)},
         {"second_contact", point(m.second_contact)},
         {"stable_ends_by", breaks ? "symmetry_breaking" : "second_contact"},
         {"stable", describe(branch_columns, m.stable)},
         {"unstable", describe(branch_columns, m.unstable)},
         {"asymmetric", describe(branch_columns, m.asymmetric)},
         {"free_amplitude", or_null(m.free_amplitude)},
         {"b_at_free_amplitude", or_null(m.b_at_free_amplitude)}});
}

Json describe_manifold(const ManifoldResult& m) {
    Json j = m.manifold ? describe_manifold(*m.manifold) : Json::object();
    j["points"] = {{quantity.tau.name, column(m.tau)}};
    j["points"].update(describe(branch_columns, m.points));
    return j;
}

Json describe_recommendation(const std::optional<Recommendation>& r) {
    if (!r) return nullptr;
    return object(
        {{"b", r->b},
         {"fold_share", r->fold_share},
         {"x_rms_ratio", r->x_rms_ratio},
         {"x_max", r->x_max},
         {"regime", name_of(r->regime)},
         {"start", r->start.name}});
}

namespace {

const char* describe_type(const Regime& r) {
    switch (r.type) {
        case RegimeType::none: return r.forced ? "no impacts" : "free decay, no forcing";
        case RegimeType::I: return "sparse irregular impacts, no stretch of two per cycle";
        case RegimeType::II:
            return "strongly modulated response: stretches of two impacts per cycle between others";
        case RegimeType::III: return "two symmetric impacts per cycle, periodic";
        case RegimeType::IV: return "two asymmetric impacts per cycle, periodic";
        case RegimeType::V: return "another number of impacts per cycle, periodic";
        case RegimeType::VI: return "irregular, more than two impacts per cycle";
    }
    return "";
}

/// Floquet multipliers of one period, by descending modulus.
Json describe_multipliers(const PeriodicOrbit& orbit) {
    return object(
        {{"re", column(orbit.multipliers, [](auto m) { return m.real(); })},
         {"im", column(orbit.multipliers, [](auto m) { return m.imag(); })},
         {"modulus", column(orbit.multipliers, elementary::modulus)}});
}

Json describe_capture(const Capture& c) {
    return object(
        {{"tau", or_null(c.tau)},
         {"status", c.tau ? "captured" : "on_its_way"},
         {"chaotic_before", or_null(c.chaotic_before)},
         {"exponents_before", describe_final(c.before)},
         {"exponents_after", describe_final(c.after)}});
}

Json describe_point(const PeriodicOrbit& o) {
    return object(
        {{"tau", o.tau},
         {"x_dot", o.state.x_dot},
         {"x", o.state.x},
         {"y_dot", o.state.y_dot},
         {"y", o.state.y}});
}

void add_orbit(Json& j, const std::optional<PeriodicOrbit>& orbit) {
    const auto of_orbit = [&](auto value) { return orbit ? Json(value(*orbit)) : Json(nullptr); };
    using Orbit = PeriodicOrbit;
    append(
        j, {{"period_cycles", of_orbit([](const Orbit& o) { return o.cycles; })},
            {"impacts_per_period", of_orbit([](const Orbit& o) { return o.contacts; })},
            {"chatter_impacts_per_period",
             of_orbit([](const Orbit& o) { return o.impacts - o.contacts; })},
            {"sticks_per_period", of_orbit([](const Orbit& o) { return o.sticks; })},
            {"symmetric", of_orbit([](const Orbit& o) { return o.symmetric; })},
            {"stable", of_orbit([](const Orbit& o) { return o.stable(); })},
            {"closure", of_orbit([](const Orbit& o) { return o.closure; })},
            {"multipliers", of_orbit(describe_multipliers)},
            {"orbit", of_orbit(describe_point)}});
}

}  // namespace

Json describe_regime(const Regime& r) {
    Json j = object(
        {{"type", name_of(r.type)},
         {"description", describe_type(r)},
         {"z", r.z},
         {"z_overall", r.z_overall},
         {"contacts", r.contacts},
         {"periodic", r.orbit.has_value()}});
    add_orbit(j, r.orbit);
    append(
        j, {{"capture", r.capture ? describe_capture(*r.capture) : Json(nullptr)},
            {"cycles_with", column(r.cycles_with)},
            {"share_two_impacts", r.cycles_with.size() > 2 ? r.cycles_with[2] : 0},
            {"z_moving", describe(moving_z_columns, r)},
            {"synchronised",
             object({{"share", r.synchronised}, {"longest_half_cycles", r.longest_synchronised}})},
            {"stretches", describe(stretch_columns, r.stretches)}});
    return j;
}

}  // namespace vines::api
