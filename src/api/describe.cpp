#include "api/describe.hpp"

#include <cmath>

#include "api/column.hpp"
#include "api/object.hpp"
#include "api/schema/words.hpp"

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
         {"damping", word(p.damping)},
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

Json describe_sticks(const std::vector<StuckPhase>& sticks) {
    return object(
        {{"side", column(sticks, [](const auto& s) { return s.start.side; })},
         {"tau_start", column(sticks, [](const auto& s) { return s.start.tau; })},
         {"tau_end", column(sticks, [](const auto& s) { return s.tau_end; })},
         {"impacts", column(sticks, [](const auto& s) { return s.start.impacts; })}});
}

Json describe_touches(const std::vector<TangentContact>& touches) {
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
    auto moments = [](const DecayMoments& m) {
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

}  // namespace vines::api
