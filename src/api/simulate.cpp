#include "api/simulate.hpp"

#include <algorithm>
#include <cmath>

#include "api/describe.hpp"
#include "api/si_columns.hpp"
#include "core/stability/windows.hpp"

namespace vines::api {

namespace {

/// |x''/(x'- - y'-)| from which on an impact is nearly tangent: without the wall the mass would
/// have turned back within 1/1800 of a unit of tau. M's condition number is then about 14 (x''/(x'-
/// - y'-))^2 at Table 1's R = .6, so that a relative error of one ulp in what M acts on is one of
/// 1e-8 in what it gives.
constexpr double nearly_tangent = 1800;

Json describe_parameters(const SimulateRequest& r) {
    Json j = describe_system(r.system);
    j.update(
        {{"x0", r.start.x},
         {"x_dot0", r.start.x_dot},
         {"y0", r.start.y},
         {"y_dot0", r.start.y_dot},
         {"tau_end", r.tau_end},
         {"cycles", r.tau_end / r.system.parameters.cycle()},
         {"window", {r.window.from, r.window.to}},
         {"samples_per_cycle", r.samples_per_cycle},
         {"section_phase", r.section_phase},
         {"max_points", r.max_points},
         {"max_impacts", r.max_impacts}});
    if (r.system.si)
        j["si"].update(
            {{"x_velocity0", r.start.x_dot * r.system.si->omega0()},
             {"y_velocity0", r.start.y_dot * r.system.si->omega0()}});
    j["derived"] = describe_derived(r.system);
    return j;
}

Json describe_status(const Outcome& outcome, const SimulateRequest& r, const Stop& stop) {
    switch (outcome.reason) {
        case End::tau_end:
            return {
                {"reason", "tau_end"}, {"tau", outcome.tau}, {"message", "the run is complete"}};
        case End::max_impacts:
            return {
                {"reason", "max_impacts"},
                {"tau", outcome.tau},
                {"message", "ended after max_impacts = " + std::to_string(r.max_impacts) +
                                " impacts (or as many sticks and touches), before tau_end"}};
        case End::stopped:
            return {{"reason", stop.reason}, {"tau", outcome.tau}, {"message", stop.message}};
    }
    return nullptr;
}

double median_speed(const std::vector<Impact>& impacts) {
    if (impacts.empty()) return 1;
    std::vector<double> speeds;
    for (const Impact& i : impacts) speeds.push_back(std::abs(i.relative_speed_before));
    const auto middle = speeds.begin() + static_cast<std::ptrdiff_t>(speeds.size() / 2);
    std::nth_element(speeds.begin(), middle, speeds.end());
    return *middle;
}

/// Impacts next to a tangent contact, which shift the eigenvalues of every product that they are
/// in. Those of a chatter (the wall presses: side x'' > 0) are slow as well, but no neighbouring
/// motion misses them.
void warn_of_grazing(
    const std::vector<Impact>& impacts, const SimulateRequest& r, double typical_speed,
    Warnings& warnings) {
    long count = 0;
    const Impact* nearest = nullptr;
    for (const Impact& i : impacts) {
        if (i.side * i.x_ddot_before > 0 || i.tau < r.window.from || i.tau > r.window.to) continue;
        if (!(std::abs(i.x_ddot_before) > nearly_tangent * std::abs(i.relative_speed_before)))
            continue;
        ++count;
        if (!nearest ||
            std::abs(i.relative_speed_before) < std::abs(nearest->relative_speed_before))
            nearest = &i;
    }
    if (count > 0)
        warnings.push_back(
            "M is ill-conditioned at " + std::to_string(count) +
            " nearly tangent impact(s), most at tau = " + digits("%.6g", nearest->tau) +
            ", whose relative speed is " +
            digits("%.2g", std::abs(nearest->relative_speed_before) / typical_speed) +
            " of the median: there the motion is next to one without this impact");
}

Json describe_windows(
    const SimulateRequest& r, const Windows& windows, const Regime& regime, Warnings& warnings) {
    Json list = Json::array();
    for (std::size_t i = 0; i < windows.size(); ++i) {
        Json entry = {{"asked", {r.windows[i].from, r.windows[i].to}}};
        entry.update(describe_exponents(
            windows.product(i), growth_of(windows.product(i)), r.estimators, regime, false,
            warnings));
        list.push_back(std::move(entry));
    }
    return list;
}

/// Cuts a list to what the answer's limit leaves of it.
template <class Entries>
void list_last(
    Entries& entries, long seen, std::size_t most, const char* name, std::size_t bytes,
    Warnings& warnings) {
    trim_to_last(entries, most);
    if (seen > static_cast<long>(entries.size()))
        warnings.push_back(
            "of " + std::to_string(seen) + " " + name + " the last " +
            std::to_string(entries.size()) + " are listed" + limit_of(bytes));
}

}  // namespace

Json simulate_answer(SimulateRequest r, const Stop& stop, std::size_t most_bytes) {
    Warnings warnings = r.system.notes;
    fit_answer(r, most_bytes, warnings);
    const Parameters& p = r.system.parameters;
    const double cycle = p.cycle(), asked_step = cycle / r.samples_per_cycle;
    const double step = std::max(asked_step, r.tau_end / static_cast<double>(r.max_points - 1));
    const auto [from, to] = r.window;

    // What each part of the answer is made from, observed in one run.
    SeriesRecord series(step);
    ImpactRecord impacts(r.listed_impacts);
    SectionRecord section(from, to, r.max_points);
    StickRecord sticks(r.listed_impacts);
    TouchRecord touches(r.listed_impacts);
    // Verdict and regime rest on qr, whether or not it is listed.
    const bool judged = r.includes("regime") || r.includes("exponents") || !r.windows.empty();
    Lyapunov lyapunov(
        p, from, to,
        {true, r.estimators.eigenvalues && r.includes("exponents"),
         r.estimators.raw_product && r.includes("exponents"), r.estimators.history});
    // Their histories are for the standard errors alone.
    Windows windows(p, {r.estimators.qr, r.estimators.eigenvalues, r.estimators.raw_product, 256});
    for (const Interval& w : r.windows) windows.add(w.from, w.to);
    TransferRecord transfers(p, from, to, r.max_points);
    StroboscopicRecord stroboscopic(p), shifted(p, 0, r.section_phase);
    Energy energy(p, from, to);
    Decay decay(p, from, decay_shares);
    ContactRecord contacts;
    HalfCycles half_cycles(p, from, to, r.max_points);

    std::vector<Observer*> observers = {&sticks, &touches};
    auto observe = [&](bool wanted, auto&... observer) {
        if (wanted) (observers.push_back(&observer), ...);
    };
    observe(r.includes("series"), series);
    observe(r.includes("impacts") || r.includes("section"), impacts);
    observe(r.includes("section"), section, shifted);
    observe(judged, lyapunov);
    observe(!r.windows.empty(), windows);
    observe(r.includes("eigenvalues") || r.includes("matrices"), transfers);
    observe(judged, stroboscopic);
    observe(r.includes("energy"), energy, decay);
    observe(judged, contacts);
    observe(r.includes("manifold"), half_cycles);

    const Outcome outcome = simulate(p, r.start, {r.tau_end, r.max_impacts, stop.asked}, observers);

    const Interval reached = {std::min(from, outcome.tau), std::min(to, outcome.tau)};

    Json answer = {
        {"version", version()},
        {"parameters", describe_parameters(r)},
        {"status", describe_status(outcome, r, stop)},
        {"warnings", nullptr}};
    if (outcome.reason != End::tau_end) warnings.push_back(answer["status"]["message"]);
    if (outcome.tau <= from)
        warnings.push_back(
            "the run ended before its window began at tau = " + digits("%.6g", from));
    std::string left_out;
    // Whether a part is asked for and there is time for it.
    auto wants = [&](const char* part) {
        if (!r.includes(part) || !(stop.late && stop.late())) return r.includes(part);
        answer[part] = nullptr;
        left_out += (left_out.empty() ? "" : ", ") + std::string(part);
        return false;
    };
    if (wants("series")) {
        series.finish(outcome);
        if (step > asked_step)
            warnings.push_back(
                "the series has " + digits("%.4g", cycle / step) +
                " samples per cycle instead of " + digits("%.4g", r.samples_per_cycle) +
                ", so that it holds no more than max_points = " + std::to_string(r.max_points));
        answer["series"] = describe_series(std::move(series));
    }
    if (r.includes("impacts")) {
        list_last(impacts.impacts, impacts.seen, r.listed_impacts, "impacts", most_bytes, warnings);
        list_last(touches.touches, touches.seen, r.listed_impacts, "touches", most_bytes, warnings);
    }
    list_last(sticks.sticks, sticks.seen, r.listed_impacts, "sticks", most_bytes, warnings);
    const double typical_speed = median_speed(impacts.impacts);
    if (wants("impacts"))
        answer["impacts"] = describe_impacts(impacts.impacts, p.epsilon, typical_speed);
    answer["sticking"] = describe_sticks(sticks.sticks);
    if (r.includes("impacts") && !touches.touches.empty()) {
        answer["touches"] = describe_touches(touches.touches);
        warnings.push_back(
            "the mass touches a wall without an impact (tangent contact): neighbouring "
            "trajectories go different ways there");
    }
    const Growth growth = growth_of(lyapunov.product());
    const Regime regime = judged ? regime_of(
                                       p, r.start,
                                       {contacts, stroboscopic, reached.from, reached.to,
                                        verdict_by_exponents(growth), stop.asked})
                                 : Regime{};
    if (wants("exponents"))
        answer["exponents"] =
            describe_exponents(lyapunov.product(), growth, r.estimators, regime, true, warnings);
    if (!r.windows.empty()) answer["windows"] = describe_windows(r, windows, regime, warnings);
    warn_of_grazing(impacts.impacts, r, typical_speed, warnings);
    trim_to_last(transfers.transfers, r.max_points);
    if (transfers.seen > static_cast<long>(transfers.transfers.size()))
        warnings.push_back(
            "eigenvalues and matrices are those of the last " + std::to_string(r.max_points) +
            " impacts (max_points) of " + std::to_string(transfers.seen));
    if (wants("eigenvalues"))
        answer["eigenvalues"] = describe_eigenvalues(transfers.transfers, stop.late, warnings);
    if (wants("matrices")) answer["matrices"] = describe_matrices(transfers.transfers);
    if (wants("section"))
        answer["section"] = describe_section(section, shifted, r.window, r.max_points, warnings);
    if (wants("energy")) answer["energy"] = describe_energy(p, r.start, energy, decay, reached);
    if (wants("regime")) answer["regime"] = describe_regime(regime, r.max_points, warnings);
    if (wants("manifold")) {
        if (p.R_plus == p.R_minus) {
            answer["manifold"] = describe_manifold(p, 0, 200);
        } else {
            answer["manifold"] = Json::object();
            warnings.push_back(
                "the manifold of two symmetric impacts needs the same R at both walls: only the "
                "run's points are given");
        }
        trim_to_last(half_cycles.tau, r.max_points);
        trim_to_last(half_cycles.points, r.max_points);
        Json C = Json::array(), V = Json::array();
        for (const ManifoldPoint& point : half_cycles.points) {
            C.push_back(point.C);
            V.push_back(point.V);
        }
        answer["manifold"]["points"] = {
            {"tau", half_cycles.tau}, {"C", std::move(C)}, {"V", std::move(V)}};
    }
    if (r.system.si) {
        for (const char* part :
             {"series", "impacts", "sticking", "touches", "exponents", "windows", "eigenvalues",
              "matrices", "section", "energy", "regime", "manifold"})
            if (answer.contains(part)) add_si(answer[part], *r.system.si);
        if (answer.contains("energy") && answer["energy"].is_object())
            add_joules(answer["energy"], *r.system.si);
        answer["status"]["time_s"] = outcome.tau / r.system.si->omega0();
        add_si(answer["parameters"], *r.system.si);
    }
    if (!left_out.empty())
        warnings.push_back(
            "the time limit for one request was over before these parts were made up, which are "
            "null: " +
            left_out);
    answer["warnings"] = warnings;
    return answer;
}

Json manifold_answer(const ManifoldRequest& r) {
    Json parameters = describe_system(r.system);
    parameters["derived"] = describe_derived(r.system);
    Warnings warnings = r.system.notes;
    const auto free = free_amplitude(r.system.parameters);
    const auto recommended = recommended_b(r.system.parameters, {});
    if (!free)
        warnings.push_back(
            "an undamped oscillator at resonance has no amplitude without the absorber: there is "
            "none to reduce");
    if (free && *free > 0 && !recommended)
        warnings.push_back(
            "no b is recommended: none of those tried reduces the motion at this frequency from "
            "every start");
    const double activation =
        manifold_fold(r.system.parameters.R_plus, r.system.parameters.Omega, r.system.parameters.b)
            .C;
    if (free && *free < activation)
        warnings.push_back(
            "without the absorber the oscillator reaches " + digits("%.4g", *free) +
            " m, less than the activation amplitude " + digits("%.4g", activation) +
            " m: two impacts per cycle cannot come about; b_at_free_amplitude is the largest b for "
            "which they can");
    const double end =
        manifold_second_contact(
            r.system.parameters.R_plus, r.system.parameters.Omega, r.system.parameters.b)
            .V;
    if (r.V_max > end)
        warnings.push_back(
            "the branches end at V = " + digits("%.4g", end) +
            ", before V_max: there the mass meets the wall that it comes from a second time");
    Json manifold = describe_manifold(r.system.parameters, r.V_max, r.points);
    manifold["recommended"] = describe_recommendation(recommended);
    if (r.system.si) add_si(manifold, *r.system.si);
    return {
        {"version", version()},
        {"parameters", std::move(parameters)},
        {"warnings", warnings},
        {"manifold", std::move(manifold)}};
}

std::string version() { return VINES_VERSION; }

}  // namespace vines::api
