#include "api/sweep.hpp"

#include <fmt/format.h>

#include <cmath>

#include "api/answer_json.hpp"
#include "api/columns.hpp"
#include "api/describe.hpp"
#include "api/schema/enum_names.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

// Measured quantities of a point; null if the transient did not end.
constexpr const char* measured_quantities[] = {
    "lambda",
    "status",
    "standard_error",
    "verdict",
    "z",
    "regime",
    "periodic",
    "period_cycles",
    "impacts_per_period",
    "symmetric",
    "capture_cycle",
    "multiplier",
    "synchronised",
    "x_max",
    "x_rms",
    "x_rms_ratio",
    "x_free",
    "share_impacts",
    "impacts",
    "sticks"};

/// A section as in a bifurcation diagram, without its times.
Json describe_section(const SweepRequest& r, const Sections& sections, const Place& place) {
    Json j = r.plan.options.section == SectionKind::impact
                 ? describe(impact_section_columns, sections.impact)
                 : describe(state_columns, sections.states);
    j.erase("tau");
    if (const auto si = r.systems->si_at(place)) add_si(j, *si);
    return j;
}

void add_exponents(Json& line, const PointResult& p) {
    line["lambda"] = column(p.lambda);
    line["status"] = column(p.lambda, [](double v) { return enum_json(status_of(v)); });
    line["standard_error"] = column(p.standard_error);
}

void add_regime(Json& line, const Regime& regime, double cycle) {
    const auto& orbit = regime.orbit;
    const auto& capture = regime.capture;
    auto of_orbit = [&](auto value) { return orbit ? Json(value(*orbit)) : Json(nullptr); };
    line["z"] = regime.z;
    line["regime"] = name_of(regime.type);
    line["periodic"] = orbit.has_value();
    line["period_cycles"] = of_orbit([](const PeriodicOrbit& o) { return o.cycles; });
    line["impacts_per_period"] = of_orbit([](const PeriodicOrbit& o) { return o.contacts; });
    line["symmetric"] = of_orbit([](const PeriodicOrbit& o) { return o.symmetric; });
    line["capture_cycle"] =
        capture && capture->tau ? Json(std::round(*capture->tau / cycle)) : Json(nullptr);
    line["multiplier"] =
        of_orbit([](const PeriodicOrbit& o) { return elementary::modulus(o.multipliers[0]); });
    line["synchronised"] = regime.synchronised;
}

void add_motion(
    Json& line, const SweepRequest& r, const Place& place, const PointSystem& system,
    const PointResult& p) {
    if (!p.measured) {
        for (const char* name : measured_quantities) line[name] = nullptr;
        line["reason"] = "transient_max_impacts";
        return;
    }
    add_exponents(line, p);
    line["verdict"] = enum_json(p.verdict);
    add_regime(line, p.regime, system.parameters.cycle());
    line["x_max"] = p.x_max;
    line["x_rms"] = p.x_rms;
    line["x_rms_ratio"] = finite_or_null(p.x_rms_ratio);
    line["x_free"] = or_null(p.x_free);
    line["share_impacts"] = or_null(p.share_impacts);
    line["impacts"] = p.impacts;
    line["sticks"] = p.sticks;
    line["reason"] = p.outcome.reason == End::tau_end ? "complete" : "max_impacts";
    if (r.plan.options.section != SectionKind::none)
        line["section"] = describe_section(r, p.sections, place);
}

/// Fields of /v1/simulate that reproduce the motion.
Json describe_start(const State& s) {
    return {{"x0", s.x}, {"x_dot0", s.x_dot}, {"y0", s.y}, {"y_dot0", s.y_dot}};
}

/// Quantities that distinguish the motions of a point.
Json describe_motion(const Motion& m) {
    const PointResult& p = m.result;
    Json j = {{"start", m.start}, {"state", describe_start(m.from)}};
    if (!p.measured) {
        j["reason"] = "transient_max_impacts";
        return j;
    }
    j.update(
        {{"x_max", p.x_max},
         {"x_rms", p.x_rms},
         {"regime", name_of(p.regime.type)},
         {"verdict", enum_json(p.verdict)},
         {"z", p.regime.z},
         {"lambda1", finite_or_null(p.lambda[0])}});
    return j;
}

Json describe_peak(const Axis& axis, const Peak& peak) {
    if (!peak.motion) return {{"x_peak", nullptr}, {axis.parameter, nullptr}};
    const Motion& m = *peak.motion;
    const PointResult& p = m.result;
    Json j = {{"x_peak", p.x_max}, {axis.parameter, axis.values[peak.at]}};
    if (!m.start.empty()) j.update({{"start", m.start}, {"state", describe_start(m.from)}});
    j.update(
        {{"regime", name_of(p.regime.type)},
         {"verdict", enum_json(p.verdict)},
         {"z", p.regime.z},
         {"x_rms", p.x_rms}});
    return j;
}

/// The reason why a point's fields form no valid system.
std::string fault_of(const SweepRequest& r, const Place& place) {
    try {
        read_started_system(fields_of(r, place));
    } catch (const Problem& problem) {
        return problem.what();
    }
    return "";
}

}  // namespace

Json describe_place(const SweepRequest& r, std::size_t line) {
    const Place place = r.plan.grid.place_of(line);
    Json j = {{"type", "point"}, {"index", line}};
    for (std::size_t a = 0; a < r.axes.size(); ++a)
        if (a != r.plan.grid.reduced) j[r.axes[a].parameter] = r.axes[a].values[place.at[a]];
    if (r.starts.size() > 1) j["start"] = place.start;
    return j;
}

Json describe_point(const SweepRequest& r, std::size_t index, const SweepPoint& point) {
    const Place place = r.plan.grid.place_of(index);
    Json line = describe_place(r, index);
    if (!point.system) {
        line["error"] = fault_of(r, place);
        return line;
    }
    if (point.afresh) line["carried"] = false;
    const std::vector<const Motion*> motions = ranked(point);
    const Motion& worst = motions.empty() ? point.motions[0] : *motions.back();
    if (r.plan.default_set)
        line.update({{"start", worst.start}, {"state", describe_start(worst.from)}});
    add_motion(line, r, place, *point.system, worst.result);
    const std::optional<bool> depends = depends_on_start(point, r.plan.default_set);
    if (r.plan.default_set) {
        line["worst"] = describe_motion(worst);
        line["best"] = describe_motion(motions.empty() ? worst : *motions.front());
        line["starts"] = Json::array();
        for (const Motion& m : point.motions) line["starts"].push_back(describe_motion(m));
    } else if (point.second) {
        line["second_start"] = describe_motion(*point.second);
    }
    if (depends) line["depends_on_start"] = *depends;
    return line;
}

Json describe_row(const SweepRequest& r, std::size_t index, const RowSummary& row) {
    const Axis& axis = r.reduced_axis();
    Json line = describe_place(r, index);
    line["reduce"] = (r.plan.largest ? "max over " : "min over ") + axis.parameter;
    line.update(describe_peak(axis, row.worst));
    if (r.plan.default_set) {
        line["worst"] = describe_peak(axis, row.worst);
        line["best"] = describe_peak(axis, row.best);
        line["starts"] = Json::array();
        for (const auto& of_start : row.starts)
            line["starts"].push_back(describe_peak(axis, of_start.peak));
    }
    line["x_free_peak"] = or_null(row.x_free);
    line["points"] = row.points;
    line["points_missing"] = row.missing;
    if (row.depends_on_start) line["depends_on_start"] = *row.depends_on_start;
    return line;
}

std::string start_warning(const StartTrial& trial) {
    if (trial.elsewhere == 0) return "";
    return fmt::format(
        "the motion depends on the start: at {} of {} points with a second start it ends elsewhere "
        "(second_start); \"starts\": \"{}\" reports the worst and the best of several",
        trial.elsewhere, trial.tried, default_set_of_starts);
}

}  // namespace vines::api
