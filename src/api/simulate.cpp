#include "api/simulate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "api/properties.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace {

// The size of an answer is bounded before it is computed, from its columns per point and impact.
// Bytes for words, parameters, the orbit, 200 points on each branch of the manifold:
constexpr double rest_bytes = 64 * 1024;
// Bytes for the exponents of one window by three estimators, with their words:
constexpr double window_bytes = 2048;
constexpr double fewest_points = 256;

struct AnswerSize {
    double point = 0, impact = 0, fixed = rest_bytes;
};

AnswerSize size_of(const SimulateRequest& r) {
    const bool si = r.system.si.has_value();
    const Parts& parts = r.wanted.parts;
    const auto row = [si](const auto& columns) { return row_bytes(columns, si); };
    const auto value = [si](const Quantity& q) { return value_bytes(q, si); };
    AnswerSize size;
    size.fixed += window_bytes * static_cast<double>(r.wanted.windows.size());
    if (parts.series) size.point += row(series_columns) + row(relative_columns);
    if (parts.exponents) {
        const double history = row(history_columns);
        if (r.wanted.estimators.qr) size.point += history;
        if (r.wanted.estimators.raw_product) size.point += history + value(quantity.rounding_floor);
        if (r.wanted.estimators.eigenvalues)
            size.fixed += static_cast<double>(most_eigenvalue_entries) * history;
    }
    if (parts.moduli) size.point += row(moduli_columns);
    if (parts.matrices) size.point += row(matrix_columns);
    if (parts.section)
        size.point += row(impact_section_columns) + value(quantity.tau) + row(state_columns);
    if (parts.regime) size.point += row(moving_z_columns) + row(stretch_columns);
    if (parts.manifold) size.point += value(quantity.tau) + row(branch_columns);
    if (r.wanted.perturbation)
        size.point += row(perturbation_columns) + value(quantity.predicted_distance);
    size.impact = row(sticking_columns);
    if (parts.impacts) size.impact += row(impact_columns) + row(touch_columns);
    if (r.wanted.perturbation) size.impact += row(touch_columns);
    return size;
}

/// Lowers max_points and the count of listed impacts to fit the answer. Warns of max_points, and
/// then returns true.
bool fit_answer(SimulateRequest& r, std::size_t bytes, Warnings& warnings) {
    const AnswerSize size = size_of(r);
    const double room = std::max(0.0, static_cast<double>(bytes) - size.fixed);
    const double points = static_cast<double>(r.wanted.most_points) * size.point,
                 impacts = static_cast<double>(r.wanted.most_listed) * size.impact;
    if (points + impacts <= room) return false;
    // Points or impacts that need less than half of the room get all that they need.
    const double for_points = std::min(
                     points, std::max({room / 2, room - impacts, fewest_points * size.point})),
                 for_impacts = room - for_points;
    if (impacts > for_impacts)
        r.wanted.most_listed = static_cast<std::size_t>(std::max(1.0, for_impacts / size.impact));
    if (points <= for_points) return false;
    const std::size_t fit = static_cast<std::size_t>(for_points / size.point);
    warnings.push_back(
        "max_points is " + std::to_string(fit) + " instead of " +
        std::to_string(r.wanted.most_points) + limit_of(bytes));
    r.wanted.most_points = r.wanted.estimators.history = fit;
    return true;
}

/// About the bytes that the lists of a run take.
std::size_t expected_bytes(const SimulateRequest& r) {
    const AnalysisRequest& w = r.wanted;
    const AnswerSize size = size_of(r);
    const double samples = w.samples_per_cycle * (w.tau_end / w.parameters.cycle() + 1);
    double bytes = size.point * std::min(samples, static_cast<double>(w.most_points));
    const auto expected = impacts_expected(w);
    const auto usual = std::min(expected / 2, w.most_listed);  // two per cycle
    if (w.parts.impacts && std::min(expected, w.most_listed) <= w.most_kept)
        bytes += size.impact * static_cast<double>(usual);
    return static_cast<std::size_t>(bytes);
}

Json describe_parameters(const SimulateRequest& r) {
    const AnalysisRequest& w = r.wanted;
    Json run = describe(properties::start, w.start);
    append(
        run, {{"tau_end", w.tau_end},
              {"cycles", w.tau_end / w.parameters.cycle()},
              {"window", w.window},
              {"settle_cycles", w.settle_cycles},
              {"samples_per_cycle", w.samples_per_cycle},
              {"section_phase", w.section_phase},
              {"max_points", w.most_points},
              {"max_impacts", w.max_impacts}});
    Json j = describe_system(r.system, run);
    if (r.system.si)
        append(
            j["si"], {{"x_velocity0", w.start.x_dot * r.system.si->omega0()},
                      {"y_velocity0", w.start.y_dot * r.system.si->omega0()}});
    return j;
}

Json describe_status(const Outcome& outcome, long max_impacts, const Stop& stop) {
    auto status = [&](const std::string& reason, const std::string& message) {
        return object({{"reason", reason}, {"tau", outcome.tau}, {"message", message}});
    };
    switch (outcome.reason) {
        case End::tau_end: return status("tau_end", "the run is complete");
        case End::max_impacts:
            return status(
                "max_impacts", fmt::format(
                                   "ended after max_impacts = {} impacts (or as many sticking "
                                   "phases and grazing contacts), before tau_end",
                                   max_impacts));
        case End::stopped: return status(stop.reason, stop.message);
    }
    return nullptr;
}

Json describe_windows(
    const std::vector<WindowExponents>& windows, const ExponentOptions& shown, const Regime& regime,
    double run_end) {
    Json list = Json::array();
    for (const WindowExponents& w : windows) {
        Json entry = {{"asked", w.asked}};
        entry.update(describe_exponents(w, shown, regime, false));
        if (shown.qr && w.asked.from >= run_end)
            entry["verdict_reason"] = "the run had ended before this window began";
        list.push_back(std::move(entry));
    }
    return list;
}

/// Moves a result out, so that it is freed after it is described.
template <class Result>
Result taken(Result& result) {
    return std::exchange(result, {});
}

ImpactScales scales_of(const SimulateRequest& r, const Analysis& a) {
    return {r.wanted.parameters.epsilon, a.typical_speed};
}

/// Adds the parts of an answer with their SI counterparts, as long as there is time; returns the
/// names of those that are null for lack of it.
std::vector<std::string> add_parts(
    Json& answer, const SimulateRequest& r, Analysis& a, const Stop& stop) {
    std::vector<std::string> left_out;
    const auto add = [&](const char* name, Json part) {
        if (r.system.si) add_si(part, *r.system.si);
        append(answer, {{name, std::move(part)}});
    };
    const auto part = [&](bool is_wanted, const char* name, auto describe_part) {
        if (!is_wanted) return;
        const bool late = stop.late && stop.late();
        if (late) left_out.push_back(name);
        add(name, late ? Json(nullptr) : describe_part());
    };
    const Parts& parts = r.wanted.parts;
    const ExponentOptions& shown = r.wanted.estimators;
    part(parts.series, "series", [&] {
        const Series series = *taken(a.series);
        Json columns = describe(series_columns, series);
        if (!series.x_relative.empty()) columns.update(describe(relative_columns, series));
        return columns;
    });
    part(parts.impacts, "impacts", [&] {
        if (a.unkept_impacts) return streamed_impacts(r.system.si);
        return describe_impacts(taken(a.impacts), scales_of(r, a));
    });
    add("sticking", describe(sticking_columns, a.sticks));
    if (!a.touches.empty()) add("touches", describe(touch_columns, a.touches));
    part(parts.exponents, "exponents", [&] {
        return describe_exponents(*a.exponents, shown, *a.regime, true);
    });
    if (!a.windows.empty())
        add("windows", describe_windows(a.windows, shown, *a.regime, a.outcome.tau));
    part(parts.moduli, "eigenvalues", [&] { return describe(moduli_columns, *taken(a.moduli)); });
    part(parts.matrices, "matrices", [&] { return describe(matrix_columns, *taken(a.matrices)); });
    part(parts.section, "section", [&] { return describe_sections(*taken(a.sections)); });
    part(parts.energy, "energy", [&] { return describe_energy(*a.energy); });
    part(parts.regime, "regime", [&] { return describe_regime(*a.regime); });
    part(parts.manifold, "manifold", [&] { return describe_manifold(*a.manifold); });
    part(a.perturbation.has_value(), "perturbation", [&] {
        return describe_perturbation(*taken(a.perturbation));
    });
    return left_out;
}

/// A recommended b above this fraction of the amplitude without absorber causes a warning.
constexpr double near_free_amplitude = 0.9;

/// Warnings about a manifold and the recommended b; `late`: the search for b was cut short.
void add_manifold_warnings(
    const Manifold& m, double V_max, const Recommendations& r, bool late, Warnings& warnings) {
    const auto free = m.free_amplitude;
    if (!free)
        warnings.push_back(
            "an undamped oscillator at resonance has no finite amplitude without the absorber: "
            "there is none to reduce");
    if (late && !r.best)
        warnings.push_back(
            "no b is recommended: the server's time limit for one request ended before all were "
            "tried");
    else if (free && *free > 0 && !r.best)
        warnings.push_back(
            "no b is recommended: no tried value reduces the motion at this frequency from every "
            "start");
    if (r.best && free && r.best->b > near_free_amplitude * *free)
        warnings.push_back(fmt::format(
            "the recommended b lies {:.2g} % below the amplitude without the absorber: with an F "
            "smaller by that, or another f, a ball at rest is never met{}",
            100 * (1 - r.best->b / *free),
            r.robust ? "; robust is the b for an F and f that are not exact" : ""));
    if (free && *free < m.fold.C)
        warnings.push_back(fmt::format(
            "without the absorber the oscillator reaches {:.4g} m, less than the activation "
            "amplitude {:.4g} m: two impacts per cycle are impossible; b_at_free_amplitude is the "
            "largest b that allows them",
            *free, m.fold.C));
    if (V_max > m.second_contact.V)
        warnings.push_back(fmt::format(
            "the branches end at V = {:.4g}, before V_max: there the ball hits the wall that it "
            "comes from a second time",
            m.second_contact.V));
}

}  // namespace

Answer simulate_in_parts(
    SimulateRequest r, const Stop& stop, std::size_t most_bytes, std::size_t most_kept,
    const std::function<void(std::size_t)>& begins) {
    Warnings warnings = r.system.notes;
    const bool has_fewer_points = fit_answer(r, most_bytes, warnings);
    r.wanted.most_kept = most_kept;
    if (begins) begins(expected_bytes(r));
    Analysis analysis = analyse(r.wanted, {.run = stop.requested, .late = stop.analysis_late});
    Json answer = object(
        {{"version", version()},
         {"parameters", describe_parameters(r)},
         {"status", describe_status(analysis.outcome, r.wanted.max_impacts, stop)},
         {"warnings", nullptr}});
    if (analysis.outcome.reason != End::tau_end) warnings.push_back(answer["status"]["message"]);
    for (const Warning& w : analysis.warnings) warnings.push_back(text_of(w, most_bytes));
    const std::vector<std::string> left_out = add_parts(answer, r, analysis, stop);
    if (r.system.si) {
        if (r.wanted.parts.energy && answer["energy"].is_object())
            add_joules(answer["energy"], *r.system.si);
        answer["status"]["time_s"] = analysis.outcome.tau / r.system.si->omega0();
        add_si(answer["parameters"], *r.system.si);
    }
    if (!left_out.empty())
        warnings.push_back(
            "the time limit for one request ended before these parts were computed, which are "
            "null: " +
            joined(left_out));
    answer["warnings"] = warnings;
    const bool is_fitted =
        has_fewer_points || std::ranges::any_of(analysis.warnings, [](const Warning& w) {
            return std::holds_alternative<warning::ListCut>(w);
        });
    std::optional<ListedRun> run;
    if (analysis.unkept_impacts && answer.contains("impacts") && !answer["impacts"].is_null())
        run = ListedRun{r.wanted, *analysis.unkept_impacts, scales_of(r, analysis)};
    return {std::move(answer), std::move(run), analysis.outcome.impacts, is_fitted};
}

std::string write_answer(
    Answer answer, RunControl& control, const JsonText::Take& take, std::size_t list_bytes) {
    return write_sealed(
        answer.json, answer.provenance, take,
        answer.run ? list_generator(*answer.run, answer.json, control, list_bytes)
                   : list_in_memory);
}

Json manifold_answer(const ManifoldRequest& r, const Stop& stop) {
    const Parameters& p = r.system.parameters;
    const Manifold manifold = manifold_of(p, r.V_max, r.points);
    bool late = false;  // stop.requested() has returned true
    const Recommendations recommended =
        recommended_b(p, [&] { return late = late || (stop.requested && stop.requested()); });
    Warnings warnings = r.system.notes;
    add_manifold_warnings(manifold, r.V_max, recommended, late, warnings);
    Json described = describe_manifold(manifold);
    described["recommended"] = describe(properties::recommendation, recommended.best);
    described["robust"] = describe(properties::recommendation, recommended.robust);
    if (r.system.si) add_si(described, *r.system.si);
    return {
        {"version", version()},
        {"parameters", describe_system(r.system)},
        {"warnings", warnings},
        {"manifold", std::move(described)}};
}

}  // namespace vines::api
