#include "api/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "api/describe.hpp"
#include "api/json_text.hpp"
#include "api/properties.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace {

/// A section as in a bifurcation diagram, without its times.
Json describe_section(const SweepRequest& r, const Sections& sections) {
    Json j = r.plan.options.section == SectionKind::impact
                 ? describe(impact_section_columns, sections.impact)
                 : describe(state_columns, sections.states);
    j.erase("tau");
    return j;
}

/// Nulls without extremes.
void add_extremes(Json& j, const SweepRequest& r, const Extremes* extremes) {
    if (r.plan.options.peaks) j.update(describe(properties::peaks, extremes));
    j.update(describe(properties::impact_extremes, extremes));
}

void add_motion(Json& line, const SweepRequest& r, const PointResult& p) {
    line.update(describe(properties::point, p.measured ? &p : nullptr));
    add_extremes(line, r, p.measured ? &p.extremes : nullptr);
    line["reason"] = !p.measured                        ? "transient_max_impacts"
                     : p.outcome.reason == End::tau_end ? "complete"
                                                        : "max_impacts";
    if (p.measured && r.plan.options.section != SectionKind::none)
        line["section"] = describe_section(r, p.sections);
}

/// Quantities that distinguish the motions of a point.
Json describe_motion(const SweepRequest& r, const Motion& m) {
    const PointResult& p = m.result;
    Json j = {{"start", m.start}, {"state", describe(properties::start, m.from)}};
    if (!p.measured) {
        j["reason"] = "transient_max_impacts";
        return j;
    }
    j.update(describe(properties::motion, p));
    add_extremes(j, r, &p.extremes);
    return j;
}

Json describe_peak(const SweepRequest& r, Place place, const Peak& peak) {
    const std::size_t reduced = *r.plan.grid.reduced;
    const Axis& axis = r.axes[reduced];
    if (!peak.motion) return {{"x_peak", nullptr}, {axis.parameter, nullptr}};
    const Motion& m = *peak.motion;
    const PointResult& p = m.result;
    Json j = {{"x_peak", p.x_max}, {axis.parameter, axis.values[peak.at]}};
    if (!m.start.empty())
        j.update({{"start", m.start}, {"state", describe(properties::start, m.from)}});
    j.update(describe(properties::peak, p));
    add_extremes(j, r, &p.extremes);
    place.at[reduced] = peak.at;
    if (const auto si = r.systems->si_at(place)) add_si(j, *si);
    return j;
}

/// Largest fraction of a free motion's amplitude after the transient.
constexpr double max_remaining = 0.01;

/// A warning if the free motion of the oscillator outlasts the transient, which shows where the
/// ball has no impacts; otherwise empty.
std::string transient_warning(const Parameters& p, double cycles) {
    const double per_cycle = p.zeta() * p.cycle(), left = elementary::exp(-per_cycle * cycles);
    if (!(left > max_remaining)) return "";
    const double enough = std::ceil(-elementary::log(max_remaining) / per_cycle);
    return fmt::format(
               "after transient_cycles = {:.0f} the oscillator's free motion still has {:.0f} % of "
               "its amplitude",
               cycles, 100 * left) +
           (std::isfinite(enough) ? fmt::format("; {:.0f} cycles leave 1 %", enough)
                                  : ": it is undamped");
}

/// A warning if one axis would do, since all lengths scale together; otherwise empty.
std::string scale_warning(const SweepRequest& r) {
    const auto has_axis = [&](const std::string& name) {
        return std::ranges::find(r.axes, name, &Axis::parameter) != r.axes.end();
    };
    const std::string amplitude = has_axis("G") ? "G" : "F";
    if (!has_axis("b") || !has_axis(amplitude)) return "";
    // Lengths and velocities that do not scale with them.
    const FieldTable others = simulate_fields_where([](const Field& f) {
        return f.group == "start" || f.group == "laws" || f.group == "load";
    });
    for (const Field& f : others)
        for (std::size_t s = 0; s < r.starts.size(); ++s) {
            const Json fields = fields_of(r, {s, std::vector<std::size_t>(r.axes.size(), 0)});
            if (has_axis(f.name) || (fields.contains(f.name) && fields[f.name] != 0)) return "";
        }
    return "the motion depends on b and " + amplitude + " only by b/" + amplitude +
           ", apart from its scale: the map repeats itself along rays; an axis of b shows it all";
}

using TakeLine = std::function<void(std::size_t, const std::string&)>;

/// Formats lines on the threads that computed them, and passes them on one at a time.
class PointLineWriter : public SweepSink {
public:
    PointLineWriter(const SweepRequest& r, const TakeLine& take) : r_(r), take_(take) {}

    void point(std::size_t index, const SweepPoint& point) override {
        if (r_.basins) r_.basins->add(index, point.motions[0].result);
        pass_on(index, json_text(describe_point(r_, index, point)));
    }
    void row(std::size_t index, const RowSummary& row) override {
        pass_on(index, json_text(describe_row(r_, index, row)));
    }

private:
    void pass_on(std::size_t index, const std::string& line) {
        const std::lock_guard lock(mutex_);
        take_(index, line);
    }

    const SweepRequest& r_;
    const TakeLine& take_;
    std::mutex mutex_;
};

/// A warning if motions depend on the start; otherwise empty.
std::string start_warning(const StartTrial& trial) {
    if (trial.elsewhere == 0) return "";
    return fmt::format(
        "the motion depends on the start: at {} of {} points with a second start it ends elsewhere "
        "(second_start); \"starts\": \"{}\" reports the worst and the best of several",
        trial.elsewhere, trial.tried, default_set_of_starts);
}

}  // namespace

Json describe_place(const SweepRequest& r, std::size_t line) {
    const Place place = r.plan.grid.place_of(line);
    Json j = {{"type", "point"}, {"index", line}};
    for (std::size_t a = 0; a < r.axes.size(); ++a)
        if (a != r.plan.grid.reduced) j[r.axes[a].parameter] = r.axes[a].values[place.at[a]];
    if (r.basins) j["start"] = describe(properties::start, r.basins->system_of(place)->start);
    else if (r.starts.size() > 1) j["start"] = place.start;
    return j;
}

Json describe_point(const SweepRequest& r, std::size_t index, const SweepPoint& point) {
    const Place place = r.plan.grid.place_of(index);
    Json line = describe_place(r, index);
    if (!point.system) {
        line["error"] = joined(texts_of(faults_of_base(fields_of(r, place)), &FieldError::detail));
        return line;
    }
    if (r.basins) {
        line.update(describe(properties::motion_name, point.motions[0].result));
        return line;
    }
    if (point.afresh) line["carried"] = false;
    const std::vector<const Motion*> motions = ranked(point);
    const Motion& worst = motions.empty() ? point.motions[0] : *motions.back();
    if (r.plan.default_set)
        line.update({{"start", worst.start}, {"state", describe(properties::start, worst.from)}});
    add_motion(line, r, worst.result);
    const std::optional<bool> depends = depends_on_start(point, r.plan.default_set);
    if (r.plan.default_set) {
        line["worst"] = describe_motion(r, worst);
        line["best"] = describe_motion(r, motions.empty() ? worst : *motions.front());
        line["starts"] =
            column(point.motions, [&r](const Motion& m) { return describe_motion(r, m); });
        line["lifetime"] = describe(properties::lifetime, lifetime_of(point.motions));
    } else if (point.second) {
        line["second_start"] = describe_motion(r, *point.second);
    }
    if (depends) line["depends_on_start"] = *depends;
    if (const auto si = r.systems->si_at(place)) add_si(line, *si);
    return line;
}

Json describe_row(const SweepRequest& r, std::size_t index, const RowSummary& row) {
    const Place place = r.plan.grid.place_of(index);
    Json line = describe_place(r, index);
    line["reduce"] =
        (r.plan.largest ? "max over " : "min over ") + r.axes[*r.plan.grid.reduced].parameter;
    line.update(describe_peak(r, place, row.worst));
    if (r.plan.default_set) {
        line["worst"] = describe_peak(r, place, row.worst);
        line["best"] = describe_peak(r, place, row.best);
        line["starts"] = column(row.starts, [&](const RowSummary::FromStart& of) {
            return describe_peak(r, place, of.peak);
        });
    }
    line["x_free_peak"] = json_of(row.x_free);
    line["points"] = row.points;
    line["points_missing"] = row.missing;
    if (row.depends_on_start) line["depends_on_start"] = *row.depends_on_start;
    return line;
}

Json sweep_start(const SweepRequest& r) {
    Json axes = Json::array();
    for (const Axis& a : r.axes)
        axes.push_back({{"parameter", a.parameter}, {"values", column(a.values)}});
    const System system = read_started_system(fields_of(r, r.plan.grid.place_of(0))).system;
    Json parameters = describe_system(system);
    for (const Axis& a : r.axes) parameters["origin"][a.parameter] = "swept: the first of its axis";
    const PointOptions& options = r.plan.options;
    std::vector<std::string> warnings = system.notes;
    for (const std::string& warning :
         {system.parameters.load ? std::string()
                                 : transient_warning(system.parameters, options.transient_cycles),
          scale_warning(r)})
        if (!warning.empty()) warnings.push_back(warning);
    return {
        {"type", "start"},
        {"version", version()},
        {"commit", commit()},
        {"points", r.plan.grid.lines()},
        {"cycles",
         static_cast<double>(r.plan.runs_of_all()) * (options.cycles + options.transient_cycles)},
        {"axes", std::move(axes)},
        {"parameters", std::move(parameters)},
        {"warnings", std::move(warnings)},
        {"request", r.given}};
}

std::string done_line(std::size_t points, const SweepRequest& r) {
    Json line = {{"type", "done"}, {"points", points}};
    if (r.basins) line.update(describe_basins(r));
    return json_line(std::move(line));
}

std::string run_sweep(
    const SweepRequest& r, int threads, RunControl& control, const TakeLine& take) {
    // Basins send their last line after the pairs, so that stopped ones are not complete.
    std::size_t left = r.plan.lines.size();
    std::pair<std::size_t, std::string> last;
    const TakeLine take_others = [&](std::size_t index, const std::string& line) {
        if (!r.basins || --left > 0) take(index, line);
        else last = {index, line};
    };
    PointLineWriter lines(r, take_others);
    if (!r.basins) return start_warning(vines::run_sweep(r.plan, threads, control, lines));
    try {
        r.basins->explore(threads, r.plan.options, control);
        vines::run_sweep(r.plan, threads, control, lines);
        if (r.basins->is_complete()) r.basins->run_pairs(threads, r.plan.options, control);
        if (!last.second.empty()) take(last.first, last.second);
    } catch (const Stopped&) {}
    return "";
}

}  // namespace vines::api
