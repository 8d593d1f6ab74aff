#include "api/sweep.hpp"

#include <algorithm>

#include "api/schema/enum_names.hpp"

namespace vines::api {

bool SweepSystems::has_load() const {
    return std::ranges::any_of(
        kinds, [](const Kind& kind) { return kind.fields.forcing != nullptr; });
}

SystemFields SweepSystems::fields_at(const Place& place) const {
    const Start& start = starts[place.start];
    const Kind& kind = kinds[start.kind];
    SystemFields fields = kind.fields;
    for (std::size_t k = 0; k < kind.names.size(); ++k)
        fields.numbers[kind.names[k]] = start.values[k];
    for (std::size_t a = 0; a < axes.size(); ++a)
        fields.numbers[axes[a].parameter] = axes[a].values[place.at[a]];
    return fields;
}

std::optional<PointSystem> SweepSystems::at(const Place& place) const {
    return system_of(fields_at(place));
}

/// Without its load, which can take a tenth of a second to make.
SystemFields SweepSystems::unforced_at(const Place& place) const {
    SystemFields fields = fields_at(place);
    if (fields.forcing) fields.forcing = nullptr, fields.numbers["F"] = 0;
    return fields;
}

bool SweepSystems::is_valid(const Place& place) const {
    return system_of(unforced_at(place)).has_value();
}

std::optional<PointSystem> SweepSystems::at_value(double value) const {
    SystemFields fields = fields_at({0, std::vector<std::size_t>(axes.size(), 0)});
    if (!axes.empty()) fields.numbers[axes[0].parameter] = value;
    return system_of(fields);
}

std::optional<PointSystem> SweepSystems::system_of(const SystemFields& fields) const {
    // f can be omitted only without forcing.
    const bool is_forced =
        !fields.forcing && fields.number("F", 1) != 0 && fields.number("acceleration", 1) != 0;
    if (fields.is_in_si() && !fields.is_reduced() && !fields.has("f") && is_forced)
        return std::nullopt;
    try {
        const ResolvedSystem system = resolve(fields);
        const State start = start_of(fields, system);
        if (!validate(system.parameters, start).empty()) return std::nullopt;
        PointSystem point{system.parameters, start, max_impacts};
        if (system.si) point.units = {system.si->omega0(), system.si->m1};
        return point;
    } catch (const Problem&) {  // no valid load
        return std::nullopt;
    }
}

std::optional<SiParameters> SweepSystems::si_at(const Place& place) const {
    return resolve(unforced_at(place)).si;
}

namespace {

void check_values(const Json& j, std::size_t most, std::vector<FieldError>& errors) {
    for (const std::string& name : present(j, {"from", "to", "count", "scale"}))
        errors.push_back(
            {"/" + name, j[name], nullptr, "values and from, to, count, scale exclude each other"});
    const Json& values = j["values"];
    if (!values.is_array()) return;
    if (values.empty())
        errors.push_back({"/values", values, nullptr, "values must hold at least one number"});
    if (values.size() > most)
        errors.push_back(
            {"/values", values.size(), Json::array({1, most}),
             "values can hold at most " + std::to_string(most) + " numbers"});
}

std::vector<FieldError> faults_of(const Json& j, std::size_t most) {
    std::vector<FieldError> errors = check(axis_fields(), j);
    if (!j.contains("parameter"))
        errors.push_back({"/parameter", nullptr, swept_names(), "an axis needs its parameter"});
    else if (const Json& name = j["parameter"];
             name.is_string() &&
             std::ranges::count(swept_names(), name.get_ref<const std::string&>()) == 0)
        errors.push_back(
            {"/parameter", name, swept_names(), "there is no parameter of this name to sweep"});
    if (j.contains("values")) {
        check_values(j, most, errors);
    } else {
        for (const char* name : {"from", "to", "count"})
            if (!j.contains(name))
                errors.push_back(
                    {std::string("/") + name, nullptr, nullptr,
                     "an axis needs from, to and count, or values"});
    }
    if (!errors.empty() || j.value("scale", "linear") != "log") return errors;
    for (const char* name : {"from", "to"})
        if (!(j[name].get<double>() > 0)) {
            errors.push_back(
                {std::string("/") + name, j[name], nullptr,
                 "a logarithmic axis runs between positive numbers"});
            break;
        }
    return errors;
}

/// Reads {parameter, from, to, count, scale} or {parameter, values} with at most `most` values.
/// Errors are added to `errors`, with `where` before their pointers; the axis is then empty.
Axis read_axis(
    const Json& j, const std::string& where, std::size_t most, std::vector<FieldError>& errors) {
    if (!j.is_object()) {
        errors.push_back(
            {where, j, nullptr,
             "an axis is {parameter, from, to, count, scale} or {parameter, values}"});
        return {};
    }
    std::vector<FieldError> faults = faults_of(j, most);
    if (!faults.empty()) {
        add_errors(where, std::move(faults), errors);
        return {};
    }
    Axis axis{
        j["parameter"],
        j.contains("values")
            ? j["values"].get<std::vector<double>>()
            : spaced(j["from"], j["to"], j["count"], j.value("scale", "linear") == "log")};
    const auto [least, largest] = std::ranges::minmax(axis.values);
    for (const double value : {least, largest})
        for (FieldError& e : check(sweep_base_fields(), {{axis.parameter, value}})) {
            e.pointer = where;
            errors.push_back(std::move(e));
        }
    return axis;
}

constexpr std::size_t most_axes = 3;

/// The same errors, with pointers into the request.
void add_point_errors(
    const SweepRequest& r, std::size_t start, const std::vector<FieldError>& of_point,
    std::vector<FieldError>& errors) {
    for (FieldError e : of_point) {
        const std::string name = e.pointer.substr(1);
        const auto axis = std::ranges::find(r.axes, name, &Axis::parameter);
        e.pointer = r.starts[start].contains(name) ? "/starts/" + std::to_string(start) + e.pointer
                    : axis != r.axes.end() ? "/axes/" + std::to_string(axis - r.axes.begin())
                                           : "/base" + e.pointer;
        errors.push_back(std::move(e));
    }
}

std::vector<std::string> names_of(const Json& object) {
    return texts_of(object.items(), [](const auto& member) { return member.key(); });
}

/// The starts that are the first with their set of fields.
using KindsOfStarts = std::map<std::vector<std::string>, std::size_t>;
KindsOfStarts kinds_of_starts(const SweepRequest& r) {
    KindsOfStarts first;
    for (std::size_t start = 0; start < r.starts.size(); ++start)
        first.try_emplace(names_of(r.starts[start]), start);
    return first;
}

/// The fields of a point over those of a base.
Json fields_over(Json object, const SweepRequest& r, const Place& place) {
    object.update(r.starts[place.start]);
    for (std::size_t a = 0; a < r.axes.size(); ++a)
        object[r.axes[a].parameter] = r.axes[a].values[place.at[a]];
    return object;
}

/// The base with a short load, for all kinds of starts but the first: the load is the same.
Json with_short_load(const Json& base) {
    Json lighter = Json::object();
    for (const auto& [name, value] : base.items())
        lighter[name] = name == "forcing"
                            ? Json{{"kind", "half_sine"}, {"force_N", 1}, {"duration_s", 1}}
                            : value;
    return lighter;
}

/// Checks that the fields can be combined, with the first and with the last values of the axes.
void check_fields(
    const SweepRequest& r, const KindsOfStarts& kinds, const CancelCheck& cancel,
    std::vector<FieldError>& errors) {
    const Json lighter = with_short_load(r.base);
    for (const auto& [names, start] : kinds)
        for (const bool last : {false, true}) {
            Place place{start, {}};
            for (const Axis& a : r.axes) place.at.push_back(last ? a.values.size() - 1 : 0);
            cancel.poll();
            try {
                const bool is_first = start == kinds.begin()->second;
                read_started_system(fields_over(is_first ? r.base : lighter, r, place), false);
            } catch (const Problem& problem) {
                add_point_errors(r, start, problem.errors, errors);
                return;
            }
        }
}

// Points that are looked at before a sweep begins, in tens of milliseconds.
constexpr std::size_t most_checked = 2000;

/// Refuses starts with which no point is a valid system, as far as most_checked points tell. Other
/// points without one have an error in their line.
void check_systems(const SweepRequest& r, std::vector<FieldError>& errors) {
    Grid points{.steps = r.plan.grid.steps};
    std::size_t checked = 0;
    for (std::size_t start = 0; start < r.starts.size() && errors.size() < most_errors; ++start) {
        const auto place = [&](std::size_t i) { return Place{start, points.place_of(i).at}; };
        std::size_t i = 0;
        for (; i < points.points() && !r.systems->is_valid(place(i)); ++i)
            if (++checked > most_checked) return;
        if (i == points.points())
            add_point_errors(r, start, read_started_system(fields_of(r, place(0))).errors, errors);
    }
}

/// Reads "max over f": the axis, and whether its largest or smallest objective is wanted.
void read_reduction(SweepRequest& r, const std::string& text, std::vector<FieldError>& errors) {
    Json known = Json::array();
    for (std::size_t a = 0; a < r.axes.size(); ++a)
        for (const bool largest : {true, false}) {
            known.push_back((largest ? "max over " : "min over ") + r.axes[a].parameter);
            if (known.back() != text) continue;
            r.plan.grid.reduced = a;
            r.plan.largest = largest;
            return;
        }
    errors.push_back(
        {"/reduce", text, known,
         "reduce is the largest or the smallest objective over one of the axes"});
}

void read_axes(
    SweepRequest& r, const Json& axes, std::size_t most_points, std::vector<FieldError>& errors) {
    if (axes.size() > most_axes)
        errors.push_back(
            {"/axes", axes.size(), Json::array({1, most_axes}), "a sweep has one to three axes"});
    for (std::size_t i = 0; i < std::min(axes.size(), most_axes); ++i)
        r.axes.push_back(read_axis(axes[i], "/axes/" + std::to_string(i), most_points, errors));
    for (std::size_t i = 1; i < r.axes.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (!r.axes[k].parameter.empty() && r.axes[k].parameter == r.axes[i].parameter)
                errors.push_back(
                    {"/axes/" + std::to_string(i) + "/parameter", r.axes[i].parameter, nullptr,
                     "two axes have the same parameter"});
}

void read_starts(SweepRequest& r, const Json& given, std::vector<FieldError>& errors) {
    r.plan.default_set = given == default_set_of_starts;
    const std::size_t count = given.is_string() ? 0 : given.size();
    for (std::size_t i = 0; i < count && errors.size() < most_errors; ++i) {
        const std::string where = "/starts/" + std::to_string(i);
        if (given[i].is_object()) add_errors(where, check(start_fields(), given[i]), errors);
        else errors.push_back({where, given[i], nullptr, "a start is {x0, x_dot0, y0, y_dot0}"});
        r.starts.push_back(given[i]);
    }
    if (r.starts.empty()) r.starts.push_back(Json::object());
}

/// Swept fields must not be set elsewhere, nor fields that the default set of starts sets.
void check_overlaps(const SweepRequest& r, std::vector<FieldError>& errors) {
    const auto forbid = [&errors](
                            const Json& object, const std::string& where, const std::string& name,
                            const std::string& detail) {
        if (object.contains(name))
            errors.push_back({where + "/" + name, object[name], nullptr, detail});
    };
    for (const auto& [name, values] : r.axes) {
        forbid(r.base, "/base", name, name + " is swept; the base must not set it");
        for (std::size_t s = 0; s < r.starts.size(); ++s)
            forbid(
                r.starts[s], "/starts/" + std::to_string(s), name,
                name + " is swept; a start must not set it");
    }
    if (!r.plan.default_set) return;
    for (const Field& f : start_fields()) {
        const std::string detail = "the default set of starts sets " + f.name;
        forbid(r.base, "/base", f.name, detail);
        for (std::size_t a = 0; a < r.axes.size(); ++a)
            if (r.axes[a].parameter == f.name)
                errors.push_back(
                    {"/axes/" + std::to_string(a) + "/parameter", f.name, nullptr, detail});
    }
}

void read_options(SweepRequest& r, const Json& given, std::vector<FieldError>& errors) {
    SweepPlan& plan = r.plan;
    const WithDefaults field{sweep_fields(), given};
    const std::string section = field["section"], carry = field["carry_state"];
    const auto objective = enum_value<Objective>(field["objective"].get<std::string>());
    plan.carry = enum_value<Carry>(carry);
    plan.options = {
        .transient_cycles = field["transient_cycles"],
        .cycles = field["cycles"],
        .settle_cycles = field["settle_cycles"],
        .section = enum_value<SectionKind>(section),
        .section_points = field["section_points"],
        .section_phase = field["section_phase"],
        .carry = plan.default_set || plan.carry != Carry::none,
        .objective = objective,
        .peaks = !field["include"].empty() || is_peak(objective)};
    if (plan.default_set && plan.carry != Carry::none)
        errors.push_back(
            {"/carry_state", carry, Json::array({"none"}),
             "the default set of starts already continues from both neighbours"});
    if (plan.options.section != SectionKind::none && (plan.default_set || plan.grid.reduced))
        errors.push_back(
            {"/section", section, Json::array({"none"}),
             "a section belongs to one motion: the default set of starts and reduce report the "
             "worst of several"});
}

/// Refuses with a load all that needs the period of a forcing or a steady state.
void check_loaded(const SweepRequest& r, const Json& given, std::vector<FieldError>& errors) {
    if (!r.systems->has_load()) return;
    const SweepPlan& plan = r.plan;
    const std::string reason = " needs a harmonic forcing: each point begins its load at tau = 0";
    if (plan.default_set)
        errors.push_back(
            {"/starts", given["starts"], nullptr, "the default set of starts" + reason});
    if (plan.carry != Carry::none)
        errors.push_back(
            {"/carry_state", given["carry_state"], Json::array({"none"}), "carry_state" + reason});
    if (plan.options.section == SectionKind::stroboscopic)
        errors.push_back(
            {"/section", given["section"], Json::array({"none", "impact"}),
             "a stroboscopic section" + reason});
}

/// Expects fields that can be combined: then only their values can make a point invalid.
std::shared_ptr<const SweepSystems> systems_of(const SweepRequest& r, const KindsOfStarts& kinds) {
    SweepSystems systems{.axes = r.axes};
    const Json lighter = with_short_load(r.base);
    for (const auto& [names, start] : kinds) {
        const Place place{start, std::vector<std::size_t>(r.axes.size(), 0)};
        const MergedFields l = merge_with_preset(
            sweep_base_fields(), fields_over(systems.kinds.empty() ? r.base : lighter, r, place));
        systems.kinds.push_back({names, system_fields(l.fields)});
        systems.kinds.back().fields.forcing = systems.kinds[0].fields.forcing;
        systems.max_impacts = l["max_impacts"];
    }
    for (const Json& start : r.starts)
        systems.starts.push_back(
            {static_cast<std::size_t>(std::distance(kinds.begin(), kinds.find(names_of(start)))),
             {start.begin(), start.end()}});
    return std::make_shared<const SweepSystems>(std::move(systems));
}

}  // namespace

Json fields_of(const SweepRequest& r, const Place& place) { return fields_over(r.base, r, place); }

SweepRequest read_grid(
    const Json& given, std::size_t starts, std::size_t most_points, const CancelCheck& cancel) {
    std::vector<FieldError> errors;
    SweepRequest r;
    r.given = given;
    for (const char* name : {"indices", "format"}) r.given.erase(name);
    r.base = given.value("base", Json::object());
    read_axes(r, given["axes"], most_points, errors);
    add_errors("/base", check(sweep_base_fields(), r.base), errors);
    read_starts(r, given.value("starts", Json::array()), errors);
    check_overlaps(r, errors);
    refuse_any(errors);

    r.plan.grid = {.steps = {}, .starts = std::max(starts, r.starts.size())};
    for (const Axis& a : r.axes) r.plan.grid.steps.push_back(a.values.size());
    if (given.contains("reduce")) read_reduction(r, given["reduce"], errors);
    const std::size_t computed = r.plan.grid.points();
    if (computed > most_points)
        refuse(
            {{starts > 0 ? "/count" : "/axes", computed, Json::array({1, most_points}),
              "the sweep has " + std::to_string(computed) + " points; at most " +
                  std::to_string(most_points) + " are computed at once"}});
    const KindsOfStarts kinds = kinds_of_starts(r);
    check_fields(r, kinds, cancel, errors);
    read_options(r, given, errors);
    const std::size_t lines = r.plan.grid.lines();
    r.plan.lines =
        read_indices(given, lines, "the sweep has " + std::to_string(lines) + " points", errors);
    refuse_any(errors);
    r.systems = systems_of(r, kinds);
    check_loaded(r, given, errors);
    check_systems(r, errors);
    refuse_any(errors);
    return r;
}

SweepRequest read_sweep_request(
    const Json& given, std::size_t most_points, const CancelCheck& cancel) {
    std::vector<FieldError> errors = check(sweep_fields(), given);
    if (!given.contains("axes") || given["axes"].empty())
        errors.push_back(
            {"/axes", nullptr, nullptr,
             "a sweep needs 1 to 3 axes: {parameter, from, to, count} or {parameter, values}"});
    if (given.contains("starts") && given["starts"].size() > most_points)
        errors.push_back(
            {"/starts", given["starts"].size(), Json::array({1, most_points}),
             "there are more starts than a sweep can have points"});
    refuse_any(errors);
    SweepRequest r = read_grid(given, 0, most_points, cancel);
    r.plan.system_at = [systems = r.systems](const Place& place) { return systems->at(place); };
    return r;
}

std::vector<std::size_t> shard_of(const SweepRequest& r, std::size_t shard, std::size_t shards) {
    std::vector<std::size_t> own;
    for (const std::size_t line : r.plan.lines)
        if (line / r.plan.chain() % shards == shard) own.push_back(line);
    return own;
}

}  // namespace vines::api
