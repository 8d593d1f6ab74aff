#include "api/describe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace vines::api {

namespace {

/// A column: one value for each element.
template <class Elements, class Value>
Json column(const Elements& elements, Value value) {
    Json values = Json::array();
    values.get_ref<Json::array_t&>().reserve(elements.size());
    for (const auto& e : elements) values.push_back(value(e));
    return values;
}

Json four(const Exponents& values) { return column(values, finite_or_null); }

Json with_status(const Exponents& values) {
    return {
        {"final", four(values)},
        {"status", column(values, [](double v) { return word(status_of(v)); })}};
}

Json describe_history(const ExponentHistory& history) {
    Json columns = {{"tau", history.tau}};
    for (std::size_t k = 0; k < 4; ++k)
        columns["lambda" + std::to_string(k + 1)] = column(
            history.lambda, [k](const Exponents& lambda) { return finite_or_null(lambda[k]); });
    return columns;
}

std::string reason_of(const Judgement& judgement, const Growth& g, const Regime& r) {
    const std::string sigmas = fmt::format(
        "lambda1 = {:.3g} lies {:.1f} standard errors {} zero", g.lambda1,
        std::abs(g.lambda1 / g.standard_error[0]), g.lambda1 > 0 ? "above" : "below");
    auto orbit = [&] {
        return fmt::format(
            "a stable periodic orbit, whose largest multiplier has the modulus {:.4g}",
            std::abs(r.orbit->multipliers[0]));
    };
    auto captured = [&] {
        return "a periodic orbit captures the motion " +
               (r.capture->tau ? fmt::format("at tau = {:.1f}", *r.capture->tau)
                               : "after the run's end");
    };
    switch (judgement.reason) {
        case VerdictReason::growth:
            return fmt::format("{}; at least {:.0f} decide", sigmas, verdict_sigmas) +
                   (r.capture ? ", but " + captured() : "");
        case VerdictReason::on_orbit: return "the motion is on " + orbit();
        case VerdictReason::settling: return "the motion ends on " + orbit();
        case VerdictReason::free_decay:
            return "without forcing (G = 0) the motion dies out: it has no exponents of a long run";
        case VerdictReason::untouched:
            return "the free mass meets no wall in the end: there are no exponents to judge";
        case VerdictReason::transient:
            return "the window begins in a chaotic transient; " + captured();
        case VerdictReason::not_known_before:
            return captured() + "; the time limit left none to see whether it was chaotic before";
        case VerdictReason::no_error: return "too few impacts for a standard error of lambda1";
        case VerdictReason::within_error:
            return fmt::format("{}; less than {:.0f} decide nothing", sigmas, verdict_sigmas);
        case VerdictReason::little_growth:
            return fmt::format(
                "{}, but deviations grow by no more than e^{:.1f} in this window, as they may "
                "while one unstable orbit is left; e^{:.0f} decides",
                sigmas, g.whole, least_growth);
        case VerdictReason::algebraic_growth:
            return fmt::format(
                "{}, but deviations grow by no more than e^{:.1f} in the second half of this "
                "window: that may be algebraic growth beside a torus",
                sigmas, g.late);
        case VerdictReason::negative:
            return sigmas + ", but no stable periodic orbit was found that the motion comes to";
    }
    return "";
}

/// A period's multipliers, by descending modulus.
Json describe_multipliers(const PeriodicOrbit& orbit) {
    return {
        {"re", column(orbit.multipliers, [](auto m) { return m.real(); })},
        {"im", column(orbit.multipliers, [](auto m) { return m.imag(); })},
        {"modulus", column(orbit.multipliers, [](auto m) { return std::abs(m); })}};
}

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

Json describe_matrix(const Matrix4& m) {
    Json rows = Json::array();
    for (int i = 0; i < 4; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2), m(i, 3)});
    return rows;
}

}  // namespace

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json describe_system(const System& system) {
    const Parameters& p = system.parameters;
    Json j = {
        {"epsilon", p.epsilon}, {"lambda", p.lambda},   {"G", p.G}, {"Omega", p.Omega},
        {"R_plus", p.R_plus},   {"R_minus", p.R_minus}, {"b", p.b}, {"damping", word(p.damping)}};
    j["origin"] = system.origin;
    if (system.si) j["si"] = fields_of(*system.si);
    return j;
}

Json describe_derived(const System& system) {
    const Parameters& p = system.parameters;
    const double zeta = p.zeta();
    Json j = {
        {"zeta", zeta},
        {"omega_d", zeta < 1 ? Json(std::sqrt(1 - zeta * zeta)) : Json(nullptr)},
        {"A", p.A()},
        {"phi", p.phi()},
        {"cycle", p.cycle()}};
    if (system.si) {
        const SiParameters& si = *system.si;
        j.update(
            {{"omega0", si.omega0()},
             {"f0", si.f0()},
             {"damping_ratio", si.damping_ratio()},
             {"mass_ratio", si.epsilon()},
             {"cycle_s", 1 / si.f}});
    }
    return j;
}

Json describe_series(Series&& s) {
    return {{"tau", std::move(s.tau)},     {"x", std::move(s.x)},
            {"x_dot", std::move(s.x_dot)}, {"y", std::move(s.y)},
            {"y_dot", std::move(s.y_dot)}, {"x_ddot", std::move(s.x_ddot)}};
}

Json describe_impacts(const std::vector<Impact>& impacts, double epsilon, double typical_speed) {
    return {
        {"tau", column(impacts, [](const Impact& i) { return i.tau; })},
        {"side", column(impacts, [](const Impact& i) { return i.side; })},
        {"phase", column(impacts, [](const Impact& i) { return i.phase(); })},
        {"x", column(impacts, [](const Impact& i) { return i.x; })},
        {"x_dot_before", column(impacts, [](const Impact& i) { return i.x_dot_before; })},
        {"x_dot_after", column(impacts, [](const Impact& i) { return i.x_dot_after; })},
        {"y_dot_before", column(impacts, [](const Impact& i) { return i.y_dot_before; })},
        {"y_dot_after", column(impacts, [](const Impact& i) { return i.y_dot_after; })},
        {"x_ddot_before", column(impacts, [](const Impact& i) { return i.x_ddot_before; })},
        {"relative_speed",
         column(impacts, [](const Impact& i) { return std::abs(i.relative_speed_before); })},
        {"impulse", column(impacts, [&](const Impact& i) { return i.impulse(epsilon); })},
        {"relative_speed_ratio",
         column(
             impacts,
             [&](const Impact& i) { return std::abs(i.relative_speed_before) / typical_speed; })},
        {"grazing", column(impacts, [](const Impact& i) { return i.grazing; })}};
}

Json describe_sticks(const std::vector<StuckPhase>& sticks) {
    return {
        {"side", column(sticks, [](const auto& s) { return s.start.side; })},
        {"tau_start", column(sticks, [](const auto& s) { return s.start.tau; })},
        {"tau_end", column(sticks, [](const auto& s) { return s.tau_end; })},
        {"impacts", column(sticks, [](const auto& s) { return s.start.impacts; })}};
}

Json describe_touches(const std::vector<TangentContact>& touches) {
    return {
        {"tau", column(touches, [](const auto& t) { return t.tau; })},
        {"side", column(touches, [](const auto& t) { return t.side; })}};
}

Json describe_window(const TransferProduct& product) {
    return {
        {"window", product.impacts() > 0 ? Json::array({product.start_tau(), product.end_tau()})
                                         : Json(nullptr)},
        {"impacts", product.impacts()},
        {"sum_rule_residual", finite_or_null(product.sum_rule_residual())}};
}

void add_estimators(
    Json& j, const TransferProduct& product, const Growth& growth, const ExponentOptions& shown,
    bool histories) {
    if (shown.qr) {
        Json qr = with_status(product.qr());
        qr["standard_error"] = four(growth.standard_error);
        if (histories) qr["history"] = describe_history(product.qr_history());
        j["qr"] = std::move(qr);
    }
    if (shown.eigenvalues) {
        j["eigenvalues"] = with_status(product.eigenvalues());
        if (histories)
            j["eigenvalues"]["history"] = describe_history(product.eigenvalues_history());
    }
    if (!shown.raw_product) return;
    const double start = product.start_tau();
    const Exponents final = product.raw_product();
    Json raw = with_status(final);
    raw["rounding_floor"] = finite_or_null(rounding_floor(final[0], product.end_tau() - start));
    if (histories) {
        const ExponentHistory& history = product.raw_product_history();
        raw["history"] = describe_history(history);
        Json& floor = raw["history"]["rounding_floor"] = Json::array();
        for (std::size_t i = 0; i < history.tau.size(); ++i)
            floor.push_back(
                finite_or_null(rounding_floor(history.lambda[i][0], history.tau[i] - start)));
    }
    j["raw_product"] = std::move(raw);
}

Json describe_exponents(
    const WindowExponents& w, const ExponentOptions& shown, const Regime& regime, bool histories) {
    Json j = describe_window(w.product);
    if (shown.qr) {
        j["verdict"] = word(w.judgement.verdict);
        j["verdict_sigmas"] = finite_or_null(w.growth.lambda1 / w.growth.standard_error[0]);
        j["verdict_reason"] = reason_of(w.judgement, w.growth, regime);
    }
    add_estimators(j, w.product, w.growth, shown, histories);
    return j;
}

Json describe_moduli(const TransferModuli& m) {
    auto moduli = [](const std::vector<Moduli>& list) {
        return column(list, [](const Moduli& of_one) { return of_one; });
    };
    return {
        {"tau", m.tau},
        {"J", moduli(m.J)},
        {"M", moduli(m.M)},
        {"T", moduli(m.T)},
        {"M_condition", column(m.M_condition, finite_or_null)}};
}

Json describe_matrices(const TransferMatrices& m) {
    return {
        {"tau", m.tau},
        {"order", {"x_dot", "x", "y_dot", "y"}},
        {"J", column(m.J, describe_matrix)},
        {"M", column(m.M, describe_matrix)},
        {"T", column(m.T, describe_matrix)}};
}

Json describe_impact_section(const std::vector<SectionPoint>& points) {
    return {
        {"tau", column(points, [](const auto& p) { return p.impact.tau; })},
        {"side", column(points, [](const auto& p) { return p.impact.side; })},
        {"phase", column(points, [](const auto& p) { return p.impact.phase(); })},
        {"x", column(points, [](const auto& p) { return p.impact.x; })},
        {"x_dot_after", column(points, [](const auto& p) { return p.impact.x_dot_after; })},
        {"y_dot_after", column(points, [](const auto& p) { return p.impact.y_dot_after; })},
        {"time_difference", column(points, [](const auto& p) { return finite_or_null(p.since); })}};
}

Json describe_states(const std::vector<State>& states) {
    return {
        {"x", column(states, [](const State& s) { return s.x; })},
        {"x_dot", column(states, [](const State& s) { return s.x_dot; })},
        {"y", column(states, [](const State& s) { return s.y; })},
        {"y_dot", column(states, [](const State& s) { return s.y_dot; })}};
}

Json describe_sections(const Sections& s) {
    Json stroboscopic = {{"tau", s.tau}};
    stroboscopic.update(describe_states(s.states));
    return {
        {"impact", describe_impact_section(s.impact)}, {"stroboscopic", std::move(stroboscopic)}};
}

Json describe_energy(const EnergyResult& e) {
    const EnergyBalance& b = e.balance;
    Json j = {
        {"window", {b.window.from, b.window.to}},
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
        {"without_absorber",
         {{"rms", e.unattached->rms},
          {"peak", e.unattached->peak},
          {"amplitude", or_null(e.unattached->amplitude)}}},
        {"rms_ratio", or_null(e.rms_ratio)},
        {"peak_ratio", or_null(e.peak_ratio)}};
    if (!e.decay) return j;
    auto moments = [](const DecayMoments& m) {
        return Json{{"tau_half", or_null(m.half)}, {"tau_tenth", or_null(m.tenth)}};
    };
    j["decay"] = moments(e.decay->with_absorber);
    j["decay"]["without_absorber"] = moments(e.decay->without);
    return j;
}

namespace {

Json describe_capture(const Capture& c) {
    return {
        {"tau", or_null(c.tau)},
        {"status", c.tau ? "captured" : "on_its_way"},
        {"chaotic_before", or_null(c.chaotic_before)},
        {"exponents_before", with_status(c.before)},
        {"exponents_after", with_status(c.after)}};
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
    j["cycles_with"] = r.cycles_with;
    j["share_two_impacts"] = r.cycles_with.size() > 2 ? r.cycles_with[2] : 0;
    j["z_moving"] = {{"tau", r.moving_tau}, {"z", r.moving_z}};
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

namespace {

Json describe_points(const std::vector<ManifoldPoint>& points) {
    return {
        {"C", column(points, [](const ManifoldPoint& m) { return m.C; })},
        {"V", column(points, [](const ManifoldPoint& m) { return m.V; })}};
}

}  // namespace

Json describe_manifold(const Manifold& m) {
    auto point = [](const ManifoldPoint& of) { return Json{{"C", of.C}, {"V", of.V}}; };
    const bool breaks = m.symmetry_breaking.has_value();
    return {
        {"R", m.R},
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
        {"b_at_free_amplitude", or_null(m.b_at_free_amplitude)}};
}

Json describe_manifold(const ManifoldResult& m) {
    Json j = m.manifold ? describe_manifold(*m.manifold) : Json::object();
    j["points"] = {{"tau", m.tau}};
    j["points"].update(describe_points(m.points));
    return j;
}

Json describe_recommendation(const std::optional<Recommendation>& r) {
    if (!r) return nullptr;
    return {{"b", r->b},         {"fold_share", r->fold_share},  {"x_rms_ratio", r->x_rms_ratio},
            {"x_max", r->x_max}, {"regime", name_of(r->regime)}, {"start", r->start.name}};
}

}  // namespace vines::api
