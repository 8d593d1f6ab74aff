#include "api/describe_regime.hpp"

#include "api/column.hpp"
#include "api/describe_exponents.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

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

/// A period's multipliers, by descending modulus.
Json describe_multipliers(const PeriodicOrbit& orbit) {
    return {
        {"re", column(orbit.multipliers, [](auto m) { return m.real(); })},
        {"im", column(orbit.multipliers, [](auto m) { return m.imag(); })},
        {"modulus", column(orbit.multipliers, elementary::modulus)}};
}

Json describe_capture(const Capture& c) {
    return {
        {"tau", or_null(c.tau)},
        {"status", c.tau ? "captured" : "on_its_way"},
        {"chaotic_before", or_null(c.chaotic_before)},
        {"exponents_before", describe_final(c.before)},
        {"exponents_after", describe_final(c.after)}};
}

void add_orbit(Json& j, const std::optional<PeriodicOrbit>& orbit) {
    auto of_orbit = [&](const char* name, auto value) {
        j[name] = orbit ? Json(value(*orbit)) : Json(nullptr);
    };
    of_orbit("period_cycles", [](const PeriodicOrbit& o) { return o.cycles; });
    of_orbit("impacts_per_period", [](const PeriodicOrbit& o) { return o.contacts; });
    of_orbit("chatter_impacts_per_period", [](const PeriodicOrbit& o) {
        return o.impacts - o.contacts;
    });
    of_orbit("sticks_per_period", [](const PeriodicOrbit& o) { return o.sticks; });
    of_orbit("symmetric", [](const PeriodicOrbit& o) { return o.symmetric; });
    of_orbit("stable", [](const PeriodicOrbit& o) { return o.stable(); });
    of_orbit("closure", [](const PeriodicOrbit& o) { return o.closure; });
    of_orbit("multipliers", describe_multipliers);
    of_orbit("orbit", [](const PeriodicOrbit& o) {
        return Json{
            {"tau", o.tau},
            {"x_dot", o.state.x_dot},
            {"x", o.state.x},
            {"y_dot", o.state.y_dot},
            {"y", o.state.y}};
    });
}

}  // namespace

Json describe_regime(const Regime& r) {
    Json j = {{"type", name_of(r.type)},
              {"description", describe_type(r)},
              {"z", r.z},
              {"z_overall", r.z_overall},
              {"contacts", r.contacts},
              {"periodic", r.orbit.has_value()}};
    add_orbit(j, r.orbit);
    j["capture"] = r.capture ? describe_capture(*r.capture) : Json(nullptr);
    j["cycles_with"] = column(r.cycles_with);
    j["share_two_impacts"] = r.cycles_with.size() > 2 ? r.cycles_with[2] : 0;
    j["z_moving"] = {{"tau", column(r.moving_tau)}, {"z", column(r.moving_z)}};
    j["synchronised"] = {
        {"share", r.synchronised}, {"longest_half_cycles", r.longest_synchronised}};
    const auto& stretches = r.stretches;
    j["stretches"] = {
        {"tau_start", column(stretches, [](const auto& s) { return s.tau_start; })},
        {"tau_end", column(stretches, [](const auto& s) { return s.tau_end; })},
        {"synchronised", column(stretches, [](const auto& s) { return s.synchronised; })},
        {"contacts", column(stretches, [](const auto& s) { return s.contacts; })}};
    return j;
}

}  // namespace vines::api
