#include "api/sweep_line.hpp"

#include <algorithm>
#include <cmath>

#include "api/describe.hpp"
#include "api/si_columns.hpp"
#include "api/simulate.hpp"

namespace vines::api {

namespace {

// What a point's line says of its motion: null where there was none to measure.
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

Json describe_section_points(const std::vector<SectionPoint>& points, Section section) {
    auto column = [&](auto value) {
        Json values = Json::array();
        for (const SectionPoint& p : points) values.push_back(value(p));
        return values;
    };
    Json j;
    if (section == Section::impact) {
        j["side"] = column([](const auto& p) { return p.side; });
        j["phase"] = column([](const auto& p) { return p.phase; });
        j["x"] = column([](const auto& p) { return p.x; });
        j["x_dot_after"] = column([](const auto& p) { return p.x_dot; });
        j["y_dot_after"] = column([](const auto& p) { return p.y_dot; });
        j["time_difference"] =
            column([](const auto& p) { return finite_or_null(p.time_difference); });
    } else {
        j["x"] = column([](const auto& p) { return p.x; });
        j["x_dot"] = column([](const auto& p) { return p.x_dot; });
        j["y"] = column([](const auto& p) { return p.y; });
        j["y_dot"] = column([](const auto& p) { return p.y_dot; });
    }
    return j;
}

/// Where a line lies.
Json located(const SweepRequest& r, std::size_t index) {
    const Place place = place_of(r, index);
    Json line = {{"type", "point"}, {"index", index}};
    for (std::size_t a = 0; a < r.axes.size(); ++a)
        if (!(r.reduce && r.reduce->axis == a))
            line[r.axes[a].parameter] = r.axes[a].values[place.at[a]];
    if (r.starts.size() > 1) line["start"] = place.start;
    return line;
}

void add_motion(
    Json& line, const SweepRequest& r, const StartedSystem& system, const PointResult& p) {
    if (!p.measured) {
        for (const char* name : measured_quantities) line[name] = nullptr;
        line["reason"] = "transient_max_impacts";
        return;
    }
    line["lambda"] = Json::array();
    line["status"] = Json::array();
    line["standard_error"] = Json::array();
    for (std::size_t k = 0; k < 4; ++k) {
        line["lambda"].push_back(finite_or_null(p.lambda[k]));
        line["status"].push_back(word(status_of(p.lambda[k])));
        line["standard_error"].push_back(finite_or_null(p.standard_error[k]));
    }
    const auto& orbit = p.regime.orbit;
    const auto& capture = p.regime.capture;
    line["verdict"] = word(p.verdict);
    line["z"] = p.regime.z;
    line["regime"] = name_of(p.regime.type);
    line["periodic"] = orbit.has_value();
    line["period_cycles"] = orbit ? Json(orbit->cycles) : Json(nullptr);
    line["impacts_per_period"] = orbit ? Json(orbit->contacts) : Json(nullptr);
    line["symmetric"] = orbit ? Json(orbit->symmetric) : Json(nullptr);
    line["capture_cycle"] = capture && capture->tau
                                ? Json(std::round(*capture->tau / system.system.parameters.cycle()))
                                : Json(nullptr);
    line["multiplier"] = orbit ? Json(std::abs(orbit->multipliers[0])) : Json(nullptr);
    line["synchronised"] = p.regime.synchronised;
    line["x_max"] = p.x_max;
    line["x_rms"] = p.x_rms;
    line["x_rms_ratio"] = finite_or_null(p.x_rms_ratio);
    line["x_free"] = p.x_free ? Json(*p.x_free) : Json(nullptr);
    line["share_impacts"] = finite_or_null(p.share_impacts);
    line["impacts"] = p.impacts;
    line["sticks"] = p.sticks;
    line["reason"] = p.outcome.reason == End::tau_end ? "complete" : "max_impacts";
    if (r.options.section == Section::none) return;
    line["section"] = describe_section_points(p.section, r.options.section);
    if (system.system.si) add_si(line["section"], *system.system.si);
}

/// As fields of /v1/simulate: there the same motion comes about.
Json describe_start(const State& s) {
    return {{"x0", s.x}, {"x_dot0", s.x_dot}, {"y0", s.y}, {"y_dot0", s.y_dot}};
}

/// What tells one motion of a point from another.
Json describe_motion(const Motion& m) {
    const PointResult& p = m.result;
    if (!p.measured)
        return {
            {"start", m.start},
            {"state", describe_start(m.from)},
            {"reason", "transient_max_impacts"}};
    return {
        {"start", m.start}, {"state", describe_start(m.from)},       {"x_max", p.x_max},
        {"x_rms", p.x_rms}, {"regime", name_of(p.regime.type)},      {"verdict", word(p.verdict)},
        {"z", p.regime.z},  {"lambda1", finite_or_null(p.lambda[0])}};
}

/// A transient should leave no more of a free motion's amplitude.
constexpr double most_left = 0.01;

double peak_of(const Motion& m) { return m.result.x_max; }

/// The motions that were measured, by x_max.
std::vector<const Motion*> ranked(const SweepPoint& point) {
    std::vector<const Motion*> motions;
    for (const Motion& m : point.motions)
        if (m.result.measured) motions.push_back(&m);
    std::stable_sort(motions.begin(), motions.end(), [](const Motion* a, const Motion* b) {
        return peak_of(*a) < peak_of(*b);
    });
    return motions;
}

bool depends_on_start(const std::vector<const Motion*>& motions) {
    return std::any_of(motions.begin(), motions.end(), [&](const Motion* m) {
        return ends_elsewhere(motions.back()->result, m->result);
    });
}

/// The highest or lowest peak along a row, of the motion that `choose` takes at each point.
struct Peak {
    const SweepPoint* point = nullptr;
    const Motion* motion = nullptr;
};
template <class Choose>
Peak peak_along(const SweepRequest& r, std::span<const SweepPoint> row, Choose choose) {
    Peak peak;
    for (const SweepPoint& point : row) {
        const Motion* m = choose(point);
        if (m && (!peak.motion || (r.reduce->largest ? peak_of(*m) > peak_of(*peak.motion)
                                                     : peak_of(*m) < peak_of(*peak.motion))))
            peak = {&point, m};
    }
    return peak;
}

Json describe_peak(const SweepRequest& r, std::span<const SweepPoint> row, const Peak& peak) {
    const Axis& axis = r.axes[r.reduce->axis];
    if (!peak.motion) return {{"x_peak", nullptr}, {axis.parameter, nullptr}};
    const PointResult& p = peak.motion->result;
    Json j = {
        {"x_peak", p.x_max},
        {axis.parameter, axis.values[static_cast<std::size_t>(peak.point - row.data())]}};
    if (!peak.motion->start.empty())
        j.update({{"start", peak.motion->start}, {"state", describe_start(peak.motion->from)}});
    j.update(
        {{"regime", name_of(p.regime.type)},
         {"verdict", word(p.verdict)},
         {"z", p.regime.z},
         {"x_rms", p.x_rms}});
    return j;
}

}  // namespace

Json sweep_start(const SweepRequest& r) {
    Json axes = Json::array();
    for (const Axis& a : r.axes) axes.push_back({{"parameter", a.parameter}, {"values", a.values}});
    const System system = read_started_system(fields_of(r, place_of(r, 0))).system;
    Json parameters = describe_system(system);
    for (const Axis& a : r.axes) parameters["origin"][a.parameter] = "swept: the first of its axis";
    std::vector<std::string> warnings = system.notes;
    // Of what the oscillator does by itself, as it does where the ball is not met.
    const double left = std::exp(
        -system.parameters.zeta() * system.parameters.cycle() * r.options.transient_cycles);
    if (left > most_left) {
        const double enough = std::ceil(
            -std::log(most_left) / (system.parameters.zeta() * system.parameters.cycle()));
        warnings.push_back(
            "after transient_cycles = " + digits("%.0f", r.options.transient_cycles) +
            " the oscillator's free motion still has " + digits("%.0f", 100 * left) +
            " % of its amplitude" +
            (std::isfinite(enough) ? "; " + digits("%.0f", enough) + " leave 1 %"
                                   : ": it is undamped"));
    }
    parameters["derived"] = describe_derived(system);
    double runs = r.default_set ? 6 : static_cast<double>(r.starts.size());
    for (const Axis& a : r.axes) runs *= static_cast<double>(a.values.size());
    return {
        {"type", "start"},
        {"version", version()},
        {"points", r.points},
        {"cycles", runs * (r.options.cycles + r.options.transient_cycles)},
        {"axes", std::move(axes)},
        {"parameters", std::move(parameters)},
        {"warnings", std::move(warnings)},
        {"request", r.given}};
}

Json describe_point(const SweepRequest& r, std::size_t index, const SweepPoint& point) {
    Json line = located(r, index);
    if (!point.system) {
        line["error"] = point.error;
        return line;
    }
    if (point.afresh) line["carried"] = false;
    const std::vector<const Motion*> motions = ranked(point);
    const Motion& worst = motions.empty() ? point.motions[0] : *motions.back();
    if (r.default_set) line.update({{"start", worst.start}, {"state", describe_start(worst.from)}});
    add_motion(line, r, *point.system, worst.result);
    if (r.default_set) {
        line["worst"] = describe_motion(worst);
        line["best"] = describe_motion(motions.empty() ? worst : *motions.front());
        line["starts"] = Json::array();
        for (const Motion& m : point.motions) line["starts"].push_back(describe_motion(m));
        line["depends_on_start"] = depends_on_start(motions);
    } else if (point.second) {
        line["second_start"] = describe_motion(*point.second);
        line["depends_on_start"] = worst.result.measured && point.second->result.measured &&
                                   ends_elsewhere(worst.result, point.second->result);
    }
    return line;
}

Json describe_row(const SweepRequest& r, std::size_t index, std::span<const SweepPoint> row) {
    Json line = located(r, index);
    const Axis& axis = r.axes[r.reduce->axis];
    line["reduce"] = std::string(r.reduce->largest ? "max" : "min") + " over " + axis.parameter;
    auto worst_of = [](const SweepPoint& p) {
        const auto motions = ranked(p);
        return motions.empty() ? nullptr : motions.back();
    };
    auto best_of = [](const SweepPoint& p) {
        const auto motions = ranked(p);
        return motions.empty() ? nullptr : motions.front();
    };
    line.update(describe_peak(r, row, peak_along(r, row, worst_of)));
    if (r.default_set) {
        line["worst"] = describe_peak(r, row, peak_along(r, row, worst_of));
        line["best"] = describe_peak(r, row, peak_along(r, row, best_of));
        line["starts"] = Json::array();
        std::vector<std::string> names;
        for (const SweepPoint& p : row)
            for (const Motion& m : p.motions)
                if (std::find(names.begin(), names.end(), m.start) == names.end())
                    names.push_back(m.start);
        for (const std::string& name : names)
            line["starts"].push_back(describe_peak(
                r, row, peak_along(r, row, [&](const SweepPoint& p) {
                    const auto m =
                        std::find_if(p.motions.begin(), p.motions.end(), [&](const Motion& motion) {
                            return motion.start == name && motion.result.measured;
                        });
                    return m == p.motions.end() ? nullptr : &*m;
                })));
    }
    std::optional<double> free;
    std::size_t missing = 0, elsewhere = 0, tried = 0;
    for (const SweepPoint& p : row) {
        const auto motions = ranked(p);
        missing += motions.empty();
        if (motions.empty()) continue;
        const auto x_free = motions.back()->result.x_free;
        if (x_free && (!free || (r.reduce->largest ? *x_free > *free : *x_free < *free)))
            free = x_free;
        tried += r.default_set || p.second;
        elsewhere += r.default_set
                         ? depends_on_start(motions)
                         : p.second && ends_elsewhere(motions.back()->result, p.second->result);
    }
    line["x_free_peak"] = free ? Json(*free) : Json(nullptr);
    line["points"] = row.size();
    line["points_missing"] = missing;
    if (tried > 0) line["depends_on_start"] = elsewhere > 0;
    return line;
}

std::string start_warning(std::size_t elsewhere, std::size_t tried) {
    if (elsewhere == 0) return "";
    return "the motion depends on the start: at " + std::to_string(elsewhere) + " of " +
           std::to_string(tried) +
           " points where a second one was tried it ends elsewhere (second_start); \"starts\": \"" +
           default_set_of_starts + "\" tells the worst and the best of several";
}

}  // namespace vines::api
