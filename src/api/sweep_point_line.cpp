#include "api/sweep.hpp"

#include <fmt/format.h>

#include "api/answer_json.hpp"
#include "api/describe.hpp"
#include "api/properties.hpp"

namespace vines::api {

namespace {

/// A section as in a bifurcation diagram, without its times.
Json describe_section(const SweepRequest& r, const Sections& sections, const Place& place) {
    Json j = r.plan.options.section == SectionKind::impact
                 ? describe(impact_section_columns, sections.impact)
                 : describe(state_columns, sections.states);
    j.erase("tau");
    if (const auto si = r.systems->si_at(place)) add_si(j, *si);
    return j;
}

void add_motion(
    Json& line, const SweepRequest& r, const Place& place, const PointSystem& system,
    const PointResult& p) {
    const properties::MeasuredPoint point{p, system.parameters.cycle()};
    line.update(describe(properties::point, p.measured ? &point : nullptr));
    line["reason"] = !p.measured                        ? "transient_max_impacts"
                     : p.outcome.reason == End::tau_end ? "complete"
                                                        : "max_impacts";
    if (p.measured && r.plan.options.section != SectionKind::none)
        line["section"] = describe_section(r, p.sections, place);
}

/// Quantities that distinguish the motions of a point.
Json describe_motion(const Motion& m) {
    const PointResult& p = m.result;
    Json j = {{"start", m.start}, {"state", describe(properties::start, m.from)}};
    if (!p.measured) {
        j["reason"] = "transient_max_impacts";
        return j;
    }
    j.update(describe(properties::motion, p));
    return j;
}

Json describe_peak(const Axis& axis, const Peak& peak) {
    if (!peak.motion) return {{"x_peak", nullptr}, {axis.parameter, nullptr}};
    const Motion& m = *peak.motion;
    const PointResult& p = m.result;
    Json j = {{"x_peak", p.x_max}, {axis.parameter, axis.values[peak.at]}};
    if (!m.start.empty())
        j.update({{"start", m.start}, {"state", describe(properties::start, m.from)}});
    j.update(describe(properties::peak, p));
    return j;
}

/// The reason why a point's fields form no valid system.
std::string fault_of(const SweepRequest& r, const Place& place) {
    try {
        std::vector<std::string> details;
        for (const FieldError& e : read_started_system(fields_of(r, place)).errors)
            details.push_back(e.detail);
        return joined(details);
    } catch (const Problem& problem) {
        return problem.what();
    }
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
        line.update({{"start", worst.start}, {"state", describe(properties::start, worst.from)}});
    add_motion(line, r, place, *point.system, worst.result);
    const std::optional<bool> depends = depends_on_start(point, r.plan.default_set);
    if (r.plan.default_set) {
        line["worst"] = describe_motion(worst);
        line["best"] = describe_motion(motions.empty() ? worst : *motions.front());
        line["starts"] = Json::array();
        for (const Motion& m : point.motions) line["starts"].push_back(describe_motion(m));
        line["lifetime"] = describe(properties::lifetime, lifetime_of(point.motions));
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
