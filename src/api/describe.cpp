#include "api/describe.hpp"

#include <fmt/format.h>

#include "api/answer_json.hpp"
#include "api/properties.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

Json describe_system(const System& system) {
    Json j = describe(properties::reduced, system.parameters);
    append(j, {{"origin", system.origin}});
    if (system.si) append(j, {{"si", describe(properties::si, *system.si)}});
    return j;
}

Json describe_derived(const System& system) {
    Json j = describe(properties::derived, system.parameters);
    if (system.si) j.update(describe(properties::derived_si, *system.si));
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
    Json j = describe(properties::balance, e.balance);
    j["without_absorber"] = describe(properties::unattached, *e.unattached);
    j.update(describe(properties::energy_ratio, e));
    if (!e.decay) return j;
    j["decay"] = describe(properties::decay, e.decay->with_absorber);
    j["decay"]["without_absorber"] = describe(properties::decay, e.decay->without);
    return j;
}

Json describe_manifold(const Manifold& m) {
    auto point = [](const ManifoldPoint& of) { return describe(properties::manifold_point, of); };
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
    return r ? describe(properties::recommendation, *r) : Json(nullptr);
}

namespace {

std::string impacts_of(int count) {
    return count == 1   ? "one impact"
           : count == 2 ? "two impacts"
                        : fmt::format("{} impacts", count);
}

std::string describe_type(const Regime& r) {
    if (r.quasi_periodic) return fmt::format("quasi-periodic, {:.4g} impacts per cycle", r.z);
    if (!r.orbit && r.forced && r.contacts > 0 && r.in_every_cycle)
        return fmt::format("not periodic, with {} in every cycle", impacts_of(*r.in_every_cycle));
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
         {"chaotic_before", c.chaotic_before == true ? Json(true) : Json(nullptr)},
         {"exponents_before", describe_final(c.before)},
         {"exponents_after", describe_final(c.after)}});
}

}  // namespace

Json describe_regime(const Regime& r) {
    const PeriodicOrbit* const orbit = r.orbit ? &*r.orbit : nullptr;
    Json j = object({{"type", name_of(r.type)}, {"description", describe_type(r)}});
    j.update(describe(properties::rhythm, r));
    j.update(describe(properties::orbit, orbit));
    append(
        j, {{"multipliers", orbit ? describe_multipliers(*orbit) : Json(nullptr)},
            {"orbit", orbit ? describe(properties::orbit_state, *orbit) : Json(nullptr)},
            {"quasi_periodic", r.quasi_periodic
                                   ? describe(properties::quasi_periodic, *r.quasi_periodic)
                                   : Json(nullptr)},
            {"capture", r.capture ? describe_capture(*r.capture) : Json(nullptr)},
            {"cycles_with", column(r.cycles_with)},
            {"share_two_impacts", r.cycles_with.size() > 2 ? r.cycles_with[2] : 0},
            {"z_moving", describe(moving_z_columns, r)},
            {"synchronised", describe(properties::synchrony, r)},
            {"stretches", describe(stretch_columns, r.stretches)}});
    return j;
}

}  // namespace vines::api
