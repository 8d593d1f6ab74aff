#include "api/describe.hpp"

#include <cmath>

#include "api/answer_json.hpp"
#include "api/schema/enum_names.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

MatrixByRows by_rows(const Matrix4& m) {
    MatrixByRows rows;
    for (int i = 0; i < 4; ++i) rows[i] = {m(i, 0), m(i, 1), m(i, 2), m(i, 3)};
    return rows;
}

}  // namespace

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

Json describe_series(const Series& s) {
    return object(
        {{"tau", column(s.tau)},
         {"x", column(s.x)},
         {"x_dot", column(s.x_dot)},
         {"y", column(s.y)},
         {"y_dot", column(s.y_dot)},
         {"x_ddot", column(s.x_ddot)}});
}

Json describe_sticks(const std::vector<StickingPhase>& sticks) {
    return object(
        {{"side", column(sticks, [](const auto& s) { return s.start.side; })},
         {"tau_start", column(sticks, [](const auto& s) { return s.start.tau; })},
         {"tau_end", column(sticks, [](const auto& s) { return s.tau_end; })},
         {"impacts", column(sticks, [](const auto& s) { return s.start.impacts; })}});
}

Json describe_touches(const std::vector<GrazingEvent>& touches) {
    return object(
        {{"tau", column(touches, [](const auto& t) { return t.tau; })},
         {"side", column(touches, [](const auto& t) { return t.side; })}});
}

Json describe_moduli(const TransferModuli& m) {
    return object(
        {{"tau", column(m.tau)},
         {"J", column(m.J)},
         {"M", column(m.M)},
         {"T", column(m.T)},
         {"M_condition", column(m.M_condition)}});
}

Json describe_matrices(const TransferMatrices& m) {
    return object(
        {{"tau", column(m.tau)},
         {"order", {"x_dot", "x", "y_dot", "y"}},
         {"J", column(m.J, by_rows)},
         {"M", column(m.M, by_rows)},
         {"T", column(m.T, by_rows)}});
}

Json describe_impact_section(const std::vector<SectionPoint>& points) {
    return object(
        {{"tau", column(points, [](const auto& p) { return p.impact.tau; })},
         {"side", column(points, [](const auto& p) { return p.impact.side; })},
         {"phase", column(points, [](const auto& p) { return p.impact.phase(); })},
         {"x", column(points, [](const auto& p) { return p.impact.x; })},
         {"x_dot_after", column(points, [](const auto& p) { return p.impact.x_dot_after; })},
         {"y_dot_after", column(points, [](const auto& p) { return p.impact.y_dot_after; })},
         {"time_difference", column(points, [](const auto& p) { return p.since; })}});
}

Json describe_states(const std::vector<State>& states) {
    return object(
        {{"x", column(states, [](const State& s) { return s.x; })},
         {"x_dot", column(states, [](const State& s) { return s.x_dot; })},
         {"y", column(states, [](const State& s) { return s.y; })},
         {"y_dot", column(states, [](const State& s) { return s.y_dot; })}});
}

Json describe_sections(const Sections& s) {
    Json stroboscopic = object({{"tau", column(s.tau)}});
    stroboscopic.update(describe_states(s.states));
    return object(
        {{"impact", describe_impact_section(s.impact)}, {"stroboscopic", std::move(stroboscopic)}});
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

namespace {

Json describe_points(const std::vector<ManifoldPoint>& points) {
    return object(
        {{"C", column(points, [](const ManifoldPoint& m) { return m.C; })},
         {"V", column(points, [](const ManifoldPoint& m) { return m.V; })}});
}

}  // namespace

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
         {"stable", describe_points(m.stable)},
         {"unstable", describe_points(m.unstable)},
         {"asymmetric", describe_points(m.asymmetric)},
         {"free_amplitude", or_null(m.free_amplitude)},
         {"b_at_free_amplitude", or_null(m.b_at_free_amplitude)}});
}

Json describe_manifold(const ManifoldResult& m) {
    Json j = m.manifold ? describe_manifold(*m.manifold) : Json::object();
    j["points"] = {{"tau", column(m.tau)}};
    j["points"].update(describe_points(m.points));
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

Json describe_stretches(const std::vector<SynchronyStretch>& stretches) {
    return object(
        {{"tau_start", column(stretches, [](const auto& s) { return s.tau_start; })},
         {"tau_end", column(stretches, [](const auto& s) { return s.tau_end; })},
         {"synchronised", column(stretches, [](const auto& s) { return s.synchronised; })},
         {"contacts", column(stretches, [](const auto& s) { return s.contacts; })}});
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
            {"z_moving", object({{"tau", column(r.moving_tau)}, {"z", column(r.moving_z)}})},
            {"synchronised",
             object({{"share", r.synchronised}, {"longest_half_cycles", r.longest_synchronised}})},
            {"stretches", describe_stretches(r.stretches)}});
    return j;
}

}  // namespace vines::api
