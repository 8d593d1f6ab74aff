#include "api/describe_regime.hpp"

#include "api/column.hpp"
#include "api/describe_exponents.hpp"
#include "api/object.hpp"
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
