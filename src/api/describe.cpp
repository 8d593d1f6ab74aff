#include "api/describe.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

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
    const std::string sigmas = "lambda1 = " + digits("%.3g", g.lambda1) + " lies " +
                               digits("%.1f", std::abs(g.lambda1 / g.standard_error[0])) +
                               " standard errors " + (g.lambda1 > 0 ? "above" : "below") + " zero";
    auto orbit = [&] {
        return "a stable periodic orbit, whose largest multiplier has the modulus " +
               digits("%.4g", std::abs(r.orbit->multipliers[0]));
    };
    auto captured = [&] {
        return " a periodic orbit captures the motion " +
               (r.capture->tau ? "at tau = " + digits("%.1f", *r.capture->tau)
                               : "after the run's end");
    };
    switch (judgement.reason) {
        case VerdictReason::growth:
            return sigmas + "; at least " + digits("%.0f", verdict_sigmas) + " decide" +
                   (r.capture ? ", but" + captured() : "");
        case VerdictReason::on_orbit: return "the motion is on " + orbit();
        case VerdictReason::settling: return "the motion ends on " + orbit();
        case VerdictReason::free_decay:
            return "without forcing (G = 0) the motion dies out: it has no exponents of a long run";
        case VerdictReason::untouched:
            return "the free mass meets no wall in the end: there are no exponents to judge";
        case VerdictReason::transient:
            return "the window begins in a chaotic transient;" + captured();
        case VerdictReason::not_known_before:
            return captured().substr(1) +
                   "; the time limit left none to see whether it was chaotic before";
        case VerdictReason::no_error: return "too few impacts for a standard error of lambda1";
        case VerdictReason::within_error:
            return sigmas + "; less than " + digits("%.0f", verdict_sigmas) + " decide nothing";
        case VerdictReason::little_growth:
            return sigmas + ", but deviations grow by no more than e^" + digits("%.1f", g.whole) +
                   " in this window, as they may while one unstable orbit is left; e^" +
                   digits("%.0f", least_growth) + " decides";
        case VerdictReason::algebraic_growth:
            return sigmas + ", but deviations grow by no more than e^" + digits("%.1f", g.late) +
                   " in the second half of this window: that may be algebraic growth beside a "
                   "torus";
        case VerdictReason::negative:
            return sigmas + ", but no stable periodic orbit was found that the motion comes to";
    }
    return "";
}

/// What the window's motion is, and what that rests on.
void add_verdict(Json& j, const Growth& growth, const Regime& regime, double tau_start) {
    const Judgement judgement = judge(growth, regime, tau_start);
    j["verdict"] = word(judgement.verdict);
    j["verdict_sigmas"] = finite_or_null(growth.lambda1 / growth.standard_error[0]);
    j["verdict_reason"] = reason_of(judgement, growth, regime);
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

const char* word(Status status) {
    switch (status) {
        case Status::ok: return "ok";
        case Status::minus_infinity: return "minus_infinity";
        case Status::not_converged: return "not_converged";
    }
    return "";
}

Json word(Verdict verdict) {
    switch (verdict) {
        case Verdict::chaotic: return "chaotic";
        case Verdict::regular: return "regular";
        case Verdict::not_decided: return "not_decided";
        case Verdict::none: return nullptr;
    }
    return nullptr;
}

std::string digits(const char* format, double value) {
    char text[64];
    std::snprintf(text, sizeof text, format, value);
    return text;
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json describe_system(const System& system) {
    const Parameters& p = system.parameters;
    Json j = {
        {"epsilon", p.epsilon},
        {"lambda", p.lambda},
        {"G", p.G},
        {"Omega", p.Omega},
        {"R_plus", p.R_plus},
        {"R_minus", p.R_minus},
        {"b", p.b},
        {"damping", p.damping == Damping::closed_form ? "closed_form" : "equation_of_motion"}};
    j["origin"] = system.origin;
    if (system.si) {
        const SiParameters& si = *system.si;
        j["si"] = {{"m1", si.m1}, {"c1", si.c1}, {"k1", si.k1},
                   {"m2", si.m2}, {"F", si.F},   {"f", si.f}};
    }
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

Json describe_series(SeriesRecord&& s) {
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

Json describe_sticks(const std::vector<StickRecord::Stick>& sticks) {
    return {
        {"side", column(sticks, [](const auto& s) { return s.start.side; })},
        {"tau_start", column(sticks, [](const auto& s) { return s.start.tau; })},
        {"tau_end", column(sticks, [](const auto& s) { return s.tau_end; })},
        {"impacts", column(sticks, [](const auto& s) { return s.start.impacts; })}};
}

Json describe_touches(const std::vector<TouchRecord::Touch>& touches) {
    return {
        {"tau", column(touches, [](const auto& t) { return t.tau; })},
        {"side", column(touches, [](const auto& t) { return t.side; })}};
}

Json describe_exponents(
    const TransferProduct& product, const Growth& growth, const ExponentOptions& estimators,
    const Regime& regime, bool histories, Warnings& warnings) {
    const double start = product.start_tau(), T = product.end_tau() - start;
    Json j = {
        {"window", product.impacts() > 0 ? Json::array({start, product.end_tau()}) : Json(nullptr)},
        {"impacts", product.impacts()},
        {"sum_rule_residual", finite_or_null(product.sum_rule_residual())}};
    if (estimators.qr) {
        add_verdict(j, growth, regime, start);
        Json qr = with_status(product.qr());
        qr["standard_error"] = four(growth.standard_error);
        if (histories) qr["history"] = describe_history(product.qr_history());
        j["qr"] = std::move(qr);
    }
    if (estimators.eigenvalues) {
        j["eigenvalues"] = with_status(product.eigenvalues());
        if (histories)
            j["eigenvalues"]["history"] = describe_history(product.eigenvalues_history());
    }
    if (estimators.raw_product) {
        const Exponents final = product.raw_product();
        Json raw = with_status(final);
        raw["rounding_floor"] = finite_or_null(rounding_floor(final[0], T));
        if (histories) {
            const ExponentHistory& history = product.raw_product_history();
            raw["history"] = describe_history(history);
            Json& floor = raw["history"]["rounding_floor"] = Json::array();
            for (std::size_t i = 0; i < history.tau.size(); ++i)
                floor.push_back(
                    finite_or_null(rounding_floor(history.lambda[i][0], history.tau[i] - start)));
        }
        j["raw_product"] = std::move(raw);
        if (histories && product.impacts() > 1 && std::isnan(final[0]))
            warnings.push_back(
                "raw_product overflows in this window: the unscaled product leaves the range of "
                "double near T = 709/lambda1");
    }
    if (product.sum_rule_residual() > most_residual)
        warnings.push_back(
            "the exponents of qr in [" + digits("%.6g", start) + ", " +
            digits("%.6g", product.end_tau()) + "] miss the sum rule by " +
            digits("%.2g", product.sum_rule_residual()) +
            ": those that rounding has reached are not_converged");
    if (!histories) return j;
    if (product.impacts() < 2)
        warnings.push_back(
            "there are fewer than two impacts in the window, so there are no exponents");
    if (product.rank() == 2)
        warnings.push_back(
            "a stick falls in the window: only deviations of the centre of mass survive it, "
            "lambda3 and lambda4 are minus infinity");
    if (product.rank() == 3)
        warnings.push_back(
            "R = 0 removes every deviation of x - y at its impacts: lambda4 is minus infinity");
    return j;
}

Json describe_eigenvalues(
    std::span<const ImpactTransfer> transfers, const std::function<bool()>& late,
    Warnings& warnings) {
    constexpr std::size_t per_look = 256;
    std::vector<Moduli> T;  // from the last on
    for (std::size_t i = transfers.size(); i > 0 && !(T.size() % per_look == 0 && late && late());
         --i)
        T.push_back(transfers[i - 1].T_moduli());
    if (T.size() < transfers.size())
        warnings.push_back(
            "eigenvalues are those of the last " + std::to_string(T.size()) +
            " impacts: the time limit was over before those of the others");
    std::reverse(T.begin(), T.end());
    transfers = transfers.last(T.size());
    return {
        {"tau", column(transfers, [](const ImpactTransfer& t) { return t.tau; })},
        {"J", column(transfers, [](const ImpactTransfer& t) { return t.J_moduli(); })},
        {"M", column(transfers, [](const ImpactTransfer& t) { return t.M_moduli(); })},
        {"T", column(T, [](const Moduli& moduli) { return moduli; })},
        {"M_condition", column(transfers, [](const ImpactTransfer& t) {
             return finite_or_null(t.M.condition(t.R));
         })}};
}

Json describe_matrices(const std::vector<ImpactTransfer>& transfers) {
    return {
        {"tau", column(transfers, [](const ImpactTransfer& t) { return t.tau; })},
        {"order", {"x_dot", "x", "y_dot", "y"}},
        {"J", column(transfers, [](const ImpactTransfer& t) { return describe_matrix(t.J()); })},
        {"M",
         column(transfers, [](const ImpactTransfer& t) { return describe_matrix(t.M.matrix()); })},
        {"T", column(transfers, [](const ImpactTransfer& t) { return describe_matrix(t.T()); })}};
}

Json describe_section(
    SectionRecord& section, const StroboscopicRecord& stroboscopic, const Interval& window,
    std::size_t most, Warnings& warnings) {
    std::size_t first = 0, end = stroboscopic.states.size();
    while (first < end && stroboscopic.tau(first) < window.from) ++first;
    while (end > first && stroboscopic.tau(end - 1) > window.to) --end;
    const std::size_t cycles = end - first;
    if (section.seen > static_cast<long>(most) || cycles > most)
        warnings.push_back(
            "the sections hold their last " + std::to_string(most) + " points (max_points), of " +
            std::to_string(section.seen) + " impacts and " + std::to_string(cycles) + " cycles");
    if (cycles > most) first = end - most;
    trim_to_last(section.points, most);
    std::vector<double> tau;
    for (std::size_t k = first; k < end; ++k) tau.push_back(stroboscopic.tau(k));
    const std::span<const State> states =
        std::span(stroboscopic.states).subspan(first, end - first);
    const std::vector<SectionRecord::Point>& points = section.points;
    return {
        {"impact",
         {{"tau", column(points, [](const auto& p) { return p.impact.tau; })},
          {"side", column(points, [](const auto& p) { return p.impact.side; })},
          {"phase", column(points, [](const auto& p) { return p.impact.phase(); })},
          {"x", column(points, [](const auto& p) { return p.impact.x; })},
          {"x_dot_after", column(points, [](const auto& p) { return p.impact.x_dot_after; })},
          {"y_dot_after", column(points, [](const auto& p) { return p.impact.y_dot_after; })},
          {"time_difference",
           column(points, [](const auto& p) { return finite_or_null(p.since); })}}},
        {"stroboscopic",
         {{"tau", std::move(tau)},
          {"x", column(states, [](const State& s) { return s.x; })},
          {"x_dot", column(states, [](const State& s) { return s.x_dot; })},
          {"y", column(states, [](const State& s) { return s.y; })},
          {"y_dot", column(states, [](const State& s) { return s.y_dot; })}}}};
}

/// When a half and a tenth of the energy are left, with the absorber and without it; null where the
/// run, or an undamped motion, does not come to it.
Json describe_decay(const Parameters& p, const State& start, const Decay& decay, double tau_start) {
    auto moments = [](const std::vector<std::optional<double>>& tau) {
        auto moment = [&](std::size_t k) { return tau[k] ? Json(*tau[k]) : Json(nullptr); };
        return Json{{"tau_half", moment(0)}, {"tau_tenth", moment(1)}};
    };
    Json j = moments(decay.tau);
    j["without_absorber"] = moments(unattached_decay(p, start, tau_start, decay_shares));
    return j;
}

Json describe_energy(
    const Parameters& p, const State& start, const Energy& e, const Decay& decay,
    const Interval& window) {
    const Unattached alone = unattached(p, start, window.from, window.to);
    const double dissipated = e.impacts() + e.damper();
    auto ratio = [](double of, double to) { return to > 0 ? Json(of / to) : Json(nullptr); };
    Json j = {
        {"window", {window.from, window.to}},
        {"input", p.G == 0 ? 0 : e.input()},
        {"damper", e.damper()},
        {"impacts", e.impacts()},
        {"stored", e.stored()},
        {"residual", e.residual()},
        {"share_impacts", ratio(e.impacts(), dissipated)},
        {"at_start", e.at_start()},
        {"at_end", e.at_end()},
        {"rms", e.rms()},
        {"peak", e.peak()},
        {"without_absorber",
         {{"rms", alone.rms},
          {"peak", alone.peak},
          {"amplitude", alone.amplitude ? Json(*alone.amplitude) : Json(nullptr)}}},
        {"rms_ratio", ratio(e.rms(), alone.rms)},
        {"peak_ratio", ratio(e.peak(), alone.peak)}};
    if (p.G == 0) j["decay"] = describe_decay(p, start, decay, window.from);
    return j;
}

Json describe_regime(Regime r, std::size_t most, Warnings& warnings) {
    const std::size_t every = r.moving_tau.size() / most + 1;
    for (auto* column : {&r.moving_tau, &r.moving_z}) {
        for (std::size_t k = 0; k * every < column->size(); ++k)
            (*column)[k] = (*column)[k * every];
        column->resize((column->size() + every - 1) / every);
    }
    if (r.stretches.size() > most)
        warnings.push_back(
            "of " + std::to_string(r.stretches.size()) + " stretches the last " +
            std::to_string(most) + " are listed (max_points)");
    trim_to_last(r.stretches, most);
    if (r.search_stopped)
        warnings.push_back(
            "the search for a periodic orbit was ended by the time limit: periodic is not decided");
    Json j = {{"type", name_of(r.type)},
              {"description", describe_type(r)},
              {"z", r.z},
              {"z_overall", r.z_overall},
              {"contacts", r.contacts},
              {"periodic", r.orbit.has_value()}};
    auto of_orbit = [&](const char* name, auto value) {
        j[name] = r.orbit ? Json(value(*r.orbit)) : Json(nullptr);
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
    j["capture"] = r.capture ? Json{{"tau", r.capture->tau ? Json(*r.capture->tau) : Json(nullptr)}, {"status", r.capture->tau ? "captured" : "on_its_way"}, {"chaotic_before", r.capture->chaotic_before ? Json(*r.capture->chaotic_before) : Json(nullptr)}, {"exponents_before", with_status(r.capture->before)}, {"exponents_after", with_status(r.capture->after)}}
                             : Json(nullptr);
    if (r.capture && r.capture->chaotic_before == true)
        warnings.push_back(
            "a chaotic transient (lambda1 = " + digits("%.3g", r.capture->before[0]) +
            ") was captured by a periodic orbit " +
            (r.capture->tau ? "at tau = " + digits("%.1f", *r.capture->tau)
                            : "after the run's end") +
            " (lambda1 = " + digits("%.3g", r.capture->after[0]) +
            "): exponents of a window that reaches over it average both");
    j["cycles_with"] = r.cycles_with;
    j["share_two_impacts"] = r.cycles_with.size() > 2 ? r.cycles_with[2] : 0;
    j["z_moving"] = {{"tau", r.moving_tau}, {"z", r.moving_z}};
    j["synchronised"] = {
        {"share", r.synchronised}, {"longest_half_cycles", r.longest_synchronised}};
    j["stretches"] = {
        {"tau_start", column(r.stretches, [](const auto& s) { return s.tau_start; })},
        {"tau_end", column(r.stretches, [](const auto& s) { return s.tau_end; })},
        {"synchronised", column(r.stretches, [](const auto& s) { return s.synchronised; })},
        {"contacts", column(r.stretches, [](const auto& s) { return s.contacts; })}};
    return j;
}

Json describe_manifold(const Parameters& p, double V_max, std::size_t points) {
    const double R = p.R_plus;
    const ManifoldPoint fold = manifold_fold(R, p.Omega, p.b),
                        breaking = manifold_symmetry_breaking(R, p.Omega, p.b),
                        contact = manifold_second_contact(R, p.Omega, p.b);
    const bool breaks = breaking.V < contact.V;  // before the motion ends altogether
    const double last = std::min(V_max > 0 ? V_max : 2 * breaking.V, contact.V);
    const auto free = free_amplitude(p);
    auto point = [](const ManifoldPoint& m) { return Json{{"C", m.C}, {"V", m.V}}; };
    auto branch = [&](double from, double to) {
        const auto list = from < to ? manifold_branch(R, p.Omega, p.b, from, to, points)
                                    : std::vector<ManifoldPoint>{};
        return Json{
            {"C", column(list, [](const auto& m) { return m.C; })},
            {"V", column(list, [](const auto& m) { return m.V; })}};
    };
    return {
        {"R", R},
        {"Omega", p.Omega},
        {"b", p.b},
        {"fold", point(fold)},
        {"activation_amplitude", fold.C},
        {"symmetry_breaking", breaks ? point(breaking) : Json(nullptr)},
        {"second_contact", point(contact)},
        {"stable_ends_by", breaks ? "symmetry_breaking" : "second_contact"},
        {"stable", branch(fold.V, std::min(breaking.V, contact.V))},
        {"unstable", branch(0, fold.V)},
        {"asymmetric", branch(breaking.V, last)},
        {"free_amplitude", free ? Json(*free) : Json(nullptr)},
        {"b_at_free_amplitude", free && R < 1 ? Json(manifold_b(R, *free)) : Json(nullptr)}};
}

Json describe_recommendation(const std::optional<Recommendation>& r) {
    if (!r) return nullptr;
    return {{"b", r->b},         {"fold_share", r->fold_share},  {"x_rms_ratio", r->x_rms_ratio},
            {"x_max", r->x_max}, {"regime", name_of(r->regime)}, {"start", r->start.name}};
}

}  // namespace vines::api
