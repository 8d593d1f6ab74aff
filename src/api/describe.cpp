#include "api/describe.hpp"

#include <fmt/format.h>

#include "api/properties.hpp"

namespace vines::api {

Json describe_system(const System& system, const Json& of_run) {
    Json j = describe(properties::reduced, system.parameters),
         derived = describe(properties::derived, system.parameters);
    const auto add_table = [&j](const char* name, const auto& table) {
        if (table) j[name] = {{"speed", column(table->speed)}, {"R", column(table->R)}};
    };
    if (const auto& load = system.parameters.load)
        j["forcing"] = {
            {"kind", system.load_kind},
            {"length", finite_or_null(load->length())},
            {"sampling_error", load->sampling_error()}};
    add_table("restitution_plus", system.parameters.table_plus);
    add_table("restitution_minus", system.parameters.table_minus);
    j["origin"] = system.origin;
    if (system.si) {
        j["si"] = describe(properties::si, *system.si);
        derived.update(describe(properties::derived_si, *system.si));
    }
    j.update(of_run);
    j["derived"] = std::move(derived);
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
    auto point = [](const auto& of) { return describe(properties::manifold_point, of); };
    return object(
        {{"R", m.R},
         {"Omega", m.Omega},
         {"b", m.b},
         {"fold", point(m.fold)},
         {"activation_amplitude", m.fold.C},
         {"symmetry_breaking", point(m.symmetry_breaking)},
         {"second_contact", point(m.second_contact)},
         {"stable_ends_by", m.symmetry_breaking ? "symmetry_breaking" : "second_contact"},
         {"stable", describe(branch_columns, m.stable)},
         {"unstable", describe(branch_columns, m.unstable)},
         {"asymmetric", describe(branch_columns, m.asymmetric)},
         {"free_amplitude", json_of(m.free_amplitude)},
         {"b_at_free_amplitude", json_of(m.b_at_free_amplitude)}});
}

Json describe_manifold(const ManifoldResult& m) {
    Json j = m.manifold ? describe_manifold(*m.manifold) : Json::object();
    j["points"] = {{quantity.tau.name, column(m.tau)}};
    j["points"].update(describe(branch_columns, m.points));
    return j;
}

namespace {

std::string impacts_of(int count) {
    return count == 1   ? "one impact"
           : count == 2 ? "two impacts"
                        : fmt::format("{} impacts", count);
}

std::string describe_type(const Regime& r) {
    if (!r.has_period) return "the load has no period, and the response no regime";
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

Json describe_capture(const Capture& c) {
    return object(
        {{"tau", json_of(c.tau)},
         {"status", c.tau ? "captured" : "on_its_way"},
         {"chaotic_before", c.chaotic_before == true ? Json(true) : Json(nullptr)},
         {"exponents_before", describe(properties::final_exponents, c.before)},
         {"exponents_after", describe(properties::final_exponents, c.after)}});
}

/// `untouched`: Regime::untouched.
std::string reason_of_no_impacts(const std::optional<Regime::Untouched>& untouched) {
    if (!untouched) return "there are no impacts in this window";
    return "there are no impacts in this window, but " +
           (untouched->held ? "friction may not hold the ball for ever"
            : untouched->y_dot == 0
                ? std::string("the oscillator has not reached its steady motion")
                : fmt::format("the ball flies with y' = {:.3g} m", untouched->y_dot)) +
           (untouched->next_contact
                ? fmt::format(": the next contact is due at tau = {:.6g}", *untouched->next_contact)
                : ": no contact within the next 10,000 cycles");
}

std::string reason_of(const Judgement& judgement, const Growth& g, const Regime& r) {
    const std::string sigmas = fmt::format(
        "lambda1 = {:.3g} lies {:.1f} standard errors {} zero", g.lambda1,
        std::abs(g.lambda1 / g.standard_error[0]), g.lambda1 > 0 ? "above" : "below");
    auto orbit = [&] {
        return fmt::format(
            "a stable periodic orbit, whose largest multiplier has the modulus {:.4g}",
            elementary::modulus(r.orbit->multipliers[0]));
    };
    auto captured = [&] {
        return "a periodic orbit captures the motion " +
               (r.capture->tau ? fmt::format("at tau = {:.1f}", *r.capture->tau)
                               : "after the run's end");
    };
    switch (judgement.reason) {
        case VerdictReason::growth:
            return fmt::format("{}; a verdict needs {:.1f}", sigmas, student_three_sigma) +
                   (r.capture ? ", but " + captured() : "");
        case VerdictReason::on_orbit: return "the motion is on " + orbit();
        case VerdictReason::settling: return "the motion ends on " + orbit();
        case VerdictReason::quasi_periodic:
            return fmt::format(
                "the motion is quasi-periodic: its section is a smooth closed curve, on which it "
                "makes {:.6g} turns per cycle",
                r.quasi_periodic->rotation_number);
        case VerdictReason::next_contact: return reason_of_no_impacts(r.untouched);
        case VerdictReason::free_decay:
            return "without forcing (G = 0) the motion dies out and has no long-term exponents";
        case VerdictReason::untouched:
            return "the ball has no impacts in the end, so there are no exponents to judge";
        case VerdictReason::transient:
            return "the window begins in a chaotic transient; " + captured();
        case VerdictReason::not_known_before:
            return captured() +
                   "; the time limit left no time to check whether it was chaotic before";
        case VerdictReason::no_error: return "too few impacts for a standard error of lambda1";
        case VerdictReason::within_error:
            return fmt::format("{}; a verdict needs {:.1f}", sigmas, student_three_sigma);
        case VerdictReason::little_growth:
            return fmt::format(
                "{}, but deviations grow by no more than e^{:.1f} in this window, as they can "
                "while the motion leaves one unstable orbit; a verdict needs e^{:.0f}",
                sigmas, g.whole, least_growth);
        case VerdictReason::algebraic_growth:
            return fmt::format(
                "{}, but deviations grow by no more than e^{:.1f} in the second half of this "
                "window: that can be algebraic growth near a torus",
                sigmas, g.late);
        case VerdictReason::negative:
            return sigmas + ", but no stable periodic orbit was found that the motion approaches";
    }
    return "";
}

/// 95 % interval of each exponent.
Json describe_interval(const Exponents& lambda, const Exponents& error) {
    const auto ends = [&](double sign) {
        Exponents end;
        for (int k = 0; k < 4; ++k) end[k] = lambda[k] + sign * student_95 * error[k];
        return column(end);
    };
    return object({{"level", interval_level}, {"low", ends(-1)}, {"high", ends(1)}});
}

}  // namespace

Json describe_perturbation(Perturbation&& p) {
    const std::optional<LinearStretch>& linear = p.linear;
    Json j = describe(perturbation_columns, p);
    j.update(
        {{"start", describe(properties::difference, p.start)},
         {"impacts", describe(touch_columns, p.impacts)},
         {quantity.distance.name, column(p.distance)},
         {"predicted",
          {{"lambda1", linear ? finite_or_null(linear->lambda1) : Json(nullptr)},
           {quantity.distance.name, column(p.tangent)}}},
         {"slope",
          {{"lambda1", linear ? finite_or_null(linear->slope) : Json(nullptr)},
           {quantity.tau_start.name, linear ? Json(linear->tau.from) : Json(nullptr)},
           {quantity.tau_end.name, linear ? Json(linear->tau.to) : Json(nullptr)}}},
         {quantity.parted.name, json_of(p.parted)}});
    return j;
}

Json describe_regime(const Regime& r) {
    const PeriodicOrbit* const orbit = r.orbit ? &*r.orbit : nullptr;
    Json j = object({{"type", name_of(r.type)}, {"description", describe_type(r)}});
    j.update(describe(properties::rhythm, r));
    j.update(describe(properties::orbit, orbit));
    append(
        j, {{"multipliers", orbit ? describe_multipliers(orbit->multipliers) : Json(nullptr)},
            {"orbit", describe(properties::orbit_state, r.orbit)},
            {"quasi_periodic", describe(properties::quasi_periodic, r.quasi_periodic)},
            {"capture", r.capture ? describe_capture(*r.capture) : Json(nullptr)},
            {"cycles_with", column(r.cycles_with)},
            {"share_two_impacts", r.cycles_with.size() > 2 ? r.cycles_with[2] : 0},
            {"z_moving", describe(moving_z_columns, r)},
            {"synchronised", describe(properties::synchrony, r)},
            {"stretches", describe(stretch_columns, r.stretches)}});
    return j;
}

void add_estimators(
    Json& j, const TransferProduct& product, const Growth& growth, const ExponentOptions& shown,
    bool histories, bool slopes) {
    const auto add = [&](const char* name, const Exponents& values, const Json& more,
                         const ExponentHistory& history) {
        Json part = describe(properties::final_exponents, values);
        part.update(more);
        if (histories) part["history"] = describe(history_columns, history);
        if (slopes) part["slope"] = finite_or_null(coarse_slope(history, product.start_tau()));
        j[name] = std::move(part);
    };
    if (shown.qr)
        add("qr", product.qr(),
            {{"standard_error", column(growth.standard_error)},
             {"degrees_of_freedom", degrees_of_freedom},
             {"interval", describe_interval(product.qr(), growth.standard_error)}},
            product.qr_history());
    if (shown.eigenvalues)
        add("eigenvalues", product.eigenvalues(), Json::object(), product.eigenvalues_history());
    if (!shown.raw_product) return;
    const auto floor_at = [start = product.start_tau()](const Exponents& values, double tau) {
        return rounding_floor(values[0], tau - start);
    };
    const Exponents final = product.raw_product();
    const ExponentHistory& history = product.raw_product_history();
    const char* const floor = quantity.rounding_floor.name;
    add("raw_product", final, {{floor, finite_or_null(floor_at(final, product.end_tau()))}},
        history);
    if (!histories) return;
    std::vector<double> floors;
    for (std::size_t i = 0; i < history.tau.size(); ++i)
        floors.push_back(floor_at(history.lambda[i], history.tau[i]));
    j["raw_product"]["history"][floor] = column(floors);
}

Json describe_exponents(
    const WindowExponents& w, const ExponentOptions& shown, const Regime& regime, bool histories) {
    Json j = describe(properties::window, w.product);
    if (shown.qr) {
        j["verdict"] = enum_json(w.judgement.verdict);
        j["verdict_sigmas"] = finite_or_null(w.growth.lambda1 / w.growth.standard_error[0]);
        j["verdict_reason"] = reason_of(w.judgement, w.growth, regime);
    }
    add_estimators(j, w.product, w.growth, shown, histories, true);
    return j;
}

Json describe_multipliers(const std::array<std::complex<double>, 4>& m) {
    return {
        {"re", column(m, [](auto value) { return value.real(); })},
        {"im", column(m, [](auto value) { return value.imag(); })},
        {"modulus", column(m, elementary::modulus)}};
}

}  // namespace vines::api
