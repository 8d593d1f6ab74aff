#include "api/sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "api/answer_json.hpp"
#include "api/describe.hpp"
#include "api/json_text.hpp"
#include "api/schema/tables.hpp"
#include "api/version.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

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
    for (const Field& f : start_fields())
        for (std::size_t s = 0; s < r.starts.size(); ++s) {
            // A length or a velocity that does not scale with them.
            const Json fields = fields_of(r, {s, std::vector<std::size_t>(r.axes.size(), 0)});
            if (has_axis(f.name) || (fields.contains(f.name) && fields[f.name] != 0)) return "";
        }
    return "the motion depends on b and " + amplitude + " only by b/" + amplitude +
           ", apart from its scale: the map repeats itself along rays; an axis of b shows all of "
           "it";
}

std::string json_line(Json json) { return json_text(std::move(json)) + "\n"; }

}  // namespace

Json sweep_start(const SweepRequest& r) {
    Json axes = Json::array();
    for (const Axis& a : r.axes)
        axes.push_back({{"parameter", a.parameter}, {"values", column(a.values)}});
    const System system = read_started_system(fields_of(r, r.plan.grid.place_of(0))).system;
    Json parameters = describe_system(system);
    for (const Axis& a : r.axes) parameters["origin"][a.parameter] = "swept: the first of its axis";
    parameters["derived"] = describe_derived(system);
    const PointOptions& options = r.plan.options;
    std::vector<std::string> warnings = system.notes;
    for (const std::string& warning :
         {transient_warning(system.parameters, options.transient_cycles), scale_warning(r)})
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

std::string start_line(const SweepRequest& r) {
    Json start = sweep_start(r);
    start["of"] = r.plan.lines.size();
    return json_line(std::move(start));
}

std::string progress_line(const SweepProgress& p) {
    const double rate = p.seconds > 0 ? static_cast<double>(p.done) / p.seconds : 0;
    const double left = p.done < p.of && p.runs > 0
                            ? static_cast<double>(p.runs_of - std::min(p.runs, p.runs_of)) *
                                  p.seconds / static_cast<double>(p.runs)
                            : 0;
    return json_line(
        {{"type", "progress"},
         {"done", p.done},
         {"of", p.of},
         {"per_second", rate},
         {"seconds_left", p.runs > 0 ? Json(left) : Json(nullptr)},
         {"runs", p.runs},
         {"runs_of", p.runs_of}});
}

std::string warning_line(const std::string& message) {
    return json_line({{"type", "warning"}, {"message", message}});
}

std::string done_line(std::size_t points) {
    return json_line({{"type", "done"}, {"points", points}});
}

std::string error_line(int status, const std::string& detail, std::size_t points) {
    return json_line(
        {{"type", "error"}, {"status", status}, {"detail", detail}, {"points", points}});
}

namespace {

using TakeLine = std::function<void(std::size_t, const std::string&)>;

/// Formats lines on the threads that computed them, and passes them on one at a time.
class PointLineWriter : public SweepSink {
public:
    PointLineWriter(const SweepRequest& r, const TakeLine& take) : r_(r), take_(take) {}

    void point(std::size_t index, const SweepPoint& point) override {
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

}  // namespace

std::string run_sweep(
    const SweepRequest& r, int threads, RunControl& control, const TakeLine& take) {
    PointLineWriter lines(r, take);
    return start_warning(vines::run_sweep(r.plan, threads, control, lines));
}

}  // namespace vines::api
