#include "api/sweep_request.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace vines::api {

namespace {

/// Errors of a nested object, at their place in the request.
void add_errors(
    const std::string& where, std::vector<FieldError> errors, std::vector<FieldError>& all) {
    for (FieldError& e : errors) {
        e.pointer = where + e.pointer;
        all.push_back(std::move(e));
    }
}

bool is_parameter(const std::string& name) {
    const auto& fields = sweep_base_fields();
    return std::any_of(fields.begin(), fields.end(), [&](const Field& f) {
        return f.name == name && f.type == FieldType::number;
    });
}

std::vector<std::string> parameter_names() {
    std::vector<std::string> names;
    for (const Field& f : sweep_base_fields())
        if (f.type == FieldType::number) names.push_back(f.name);
    return names;
}

/// from, ..., to in `count` steps. The ends are exact.
std::vector<double> spaced(double from, double to, std::size_t count, bool logarithmic) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        const double share =
            count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
        values.push_back(
            logarithmic ? from * std::pow(to / from, share) : from + share * (to - from));
    }
    if (count > 1) values.back() = to;
    return values;
}

Axis read_axis(
    const Json& j, const std::string& where, std::size_t most, std::vector<FieldError>& errors) {
    Axis axis;
    if (!j.is_object()) {
        errors.push_back(
            {where, j, nullptr,
             "an axis is {parameter, from, to, count, scale} or {parameter, values}"});
        return axis;
    }
    std::vector<FieldError> own = check(axis_fields(), j);
    if (!j.contains("parameter"))
        own.push_back({"/parameter", nullptr, parameter_names(), "an axis needs its parameter"});
    else if (j["parameter"].is_string() && !is_parameter(j["parameter"]))
        own.push_back(
            {"/parameter", j["parameter"], parameter_names(),
             "there is no parameter of this name to sweep"});
    if (j.contains("values")) {
        for (const char* name : {"from", "to", "count", "scale"})
            if (j.contains(name))
                own.push_back(
                    {std::string("/") + name, j[name], nullptr,
                     "values and from, to, count, scale exclude each other"});
        if (j["values"].is_array()) {
            if (j["values"].empty())
                own.push_back(
                    {"/values", j["values"], nullptr, "values must hold at least one number"});
            if (j["values"].size() > most)
                own.push_back(
                    {"/values", j["values"].size(), Json::array({1, most}),
                     "values may hold " + std::to_string(most) + " numbers"});
        }
    } else {
        for (const char* name : {"from", "to", "count"})
            if (!j.contains(name))
                own.push_back(
                    {std::string("/") + name, nullptr, nullptr,
                     "an axis needs from, to and count, or values"});
    }
    const bool logarithmic = own.empty() && j.value("scale", "linear") == "log";
    if (logarithmic && !(j["from"].get<double>() > 0 && j["to"].get<double>() > 0))
        own.push_back(
            {j["from"].get<double>() > 0 ? "/to" : "/from",
             j[j["from"].get<double>() > 0 ? "to" : "from"], nullptr,
             "a logarithmic axis runs between positive numbers"});
    if (own.empty()) {
        axis.parameter = j["parameter"];
        axis.values = j.contains("values")
                          ? j["values"].get<std::vector<double>>()
                          : spaced(
                                j["from"].get<double>(), j["to"].get<double>(),
                                static_cast<std::size_t>(j["count"].get<double>()), logarithmic);
    }
    add_errors(where, std::move(own), errors);
    return axis;
}

constexpr std::size_t most_axes = 3;

/// A field of the request, or the table's default.
Json field(const Json& object, const char* name) {
    if (object.contains(name)) return object[name];
    for (const Field& f : sweep_fields())
        if (f.name == name) return f.fallback;
    return nullptr;
}

/// The corners of the sweep must be valid systems; each point is checked again when its turn comes.
void check_corners(const SweepRequest& r, std::vector<FieldError>& errors) {
    for (std::size_t start = 0; start < r.starts.size(); ++start)
        for (std::size_t corner = 0; corner < (std::size_t{1} << r.axes.size()); ++corner) {
            Place place{start, {}};
            for (std::size_t a = 0; a < r.axes.size(); ++a)
                place.at.push_back(corner >> a & 1 ? r.axes[a].values.size() - 1 : 0);
            try {
                read_started_system(fields_of(r, place));
            } catch (const Problem& problem) {
                for (const FieldError& e : problem.errors) {
                    std::string at = "/base" + e.pointer;
                    for (std::size_t a = 0; a < r.axes.size(); ++a)
                        if (e.pointer == "/" + r.axes[a].parameter)
                            at = "/axes/" + std::to_string(a);
                    if (r.starts[start].contains(e.pointer.substr(1)))
                        at = "/starts/" + std::to_string(start) + e.pointer;
                    const bool known =
                        std::any_of(errors.begin(), errors.end(), [&](const FieldError& other) {
                            return other.pointer == at && other.value == e.value;
                        });
                    if (!known) errors.push_back({at, e.value, e.range, e.detail});
                }
            }
        }
}

/// "max over f": which axis, and whether its largest or its smallest peak.
std::optional<Reduction> read_reduction(
    const SweepRequest& r, const std::string& text, std::vector<FieldError>& errors) {
    Json known = Json::array();
    for (std::size_t a = 0; a < r.axes.size(); ++a)
        for (const bool largest : {true, false}) {
            known.push_back((largest ? "max over " : "min over ") + r.axes[a].parameter);
            if (known.back() == text) return Reduction{a, largest};
        }
    errors.push_back(
        {"/reduce", text, known,
         "reduce is the largest or the smallest x_max over one of the axes"});
    return std::nullopt;
}

std::size_t steps_between(const SweepRequest& r, std::size_t axis) {
    return r.reduce && r.reduce->axis == axis ? 1 : r.axes[axis].values.size();
}

}  // namespace

Place place_of(const SweepRequest& r, std::size_t index) {
    Place place{0, std::vector<std::size_t>(r.axes.size(), 0)};
    auto take = [&](std::size_t n) {
        const std::size_t at = index % n;
        index /= n;
        return at;
    };
    bool starts_counted = false;
    for (std::size_t a = 0; a < r.axes.size(); ++a) {
        if (r.reduce && r.reduce->axis == a) continue;
        place.at[a] = take(steps_between(r, a));
        if (!starts_counted) place.start = take(r.starts.size());
        starts_counted = true;
    }
    if (!starts_counted) place.start = take(r.starts.size());
    return place;
}

Json fields_of(const SweepRequest& r, const Place& place) {
    Json object = r.base;
    object.update(r.starts[place.start]);
    for (std::size_t a = 0; a < r.axes.size(); ++a)
        object[r.axes[a].parameter] = r.axes[a].values[place.at[a]];
    return object;
}

std::size_t chain_length(const SweepRequest& r) {
    return r.by_rows() && !r.reduce ? r.axes[0].values.size() : 1;
}

SweepRequest read_sweep_request(const Json& given, std::size_t most_points) {
    std::vector<FieldError> errors = check(sweep_fields(), given);
    if (!given.contains("axes"))
        errors.push_back(
            {"/axes", nullptr, nullptr,
             "a sweep needs axes: one to three of {parameter, from, to, count} or {parameter, "
             "values}"});
    if (!errors.empty()) refuse(std::move(errors));

    SweepRequest r;
    r.given = given;
    r.given.erase("indices");
    r.base = field(given, "base");
    const Json& axes = given["axes"];
    if (axes.empty() || axes.size() > most_axes)
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
    add_errors("/base", check(sweep_base_fields(), r.base), errors);
    const Json starts = field(given, "starts").is_string() ? Json::array() : field(given, "starts");
    r.default_set = field(given, "starts") == default_set_of_starts;
    for (std::size_t i = 0; i < starts.size() && errors.size() < most_errors; ++i) {
        const std::string where = "/starts/" + std::to_string(i);
        if (starts[i].is_object()) add_errors(where, check(start_fields(), starts[i]), errors);
        else errors.push_back({where, starts[i], nullptr, "a start is {x0, x_dot0, y0, y_dot0}"});
        r.starts.push_back(starts[i]);
    }
    if (r.starts.empty()) r.starts.push_back(Json::object());
    for (const Axis& a : r.axes) {
        if (r.base.contains(a.parameter))
            errors.push_back(
                {"/base/" + a.parameter, r.base[a.parameter], nullptr,
                 a.parameter + " is swept; the base must not set it"});
        for (std::size_t s = 0; s < r.starts.size(); ++s)
            if (r.starts[s].contains(a.parameter))
                errors.push_back(
                    {"/starts/" + std::to_string(s) + "/" + a.parameter, r.starts[s][a.parameter],
                     nullptr, a.parameter + " is swept; a start must not set it"});
    }
    if (r.default_set)
        for (const Field& f : start_fields()) {
            if (r.base.contains(f.name))
                errors.push_back(
                    {"/base/" + f.name, r.base[f.name], nullptr,
                     "the default set of starts sets " + f.name});
            for (std::size_t a = 0; a < r.axes.size(); ++a)
                if (r.axes[a].parameter == f.name)
                    errors.push_back(
                        {"/axes/" + std::to_string(a) + "/parameter", f.name, nullptr,
                         "the default set of starts sets " + f.name});
        }
    if (!errors.empty()) refuse(std::move(errors));

    if (given.contains("reduce")) r.reduce = read_reduction(r, given["reduce"], errors);
    std::size_t computed = r.starts.size();
    for (const Axis& a : r.axes) computed *= a.values.size();
    if (computed > most_points)
        refuse(
            {{"/axes", computed, Json::array({1, most_points}),
              "the sweep has " + std::to_string(computed) + " points; at most " +
                  std::to_string(most_points) + " are computed at once"}});
    r.points = r.starts.size();
    for (std::size_t a = 0; a < r.axes.size(); ++a) r.points *= steps_between(r, a);
    check_corners(r, errors);
    r.options.cycles = field(given, "cycles").get<double>();
    r.options.transient_cycles = field(given, "transient_cycles").get<double>();
    const std::string section = field(given, "section"), carry = field(given, "carry_state");
    r.options.section = section == "impact"         ? Section::impact
                        : section == "stroboscopic" ? Section::stroboscopic
                                                    : Section::none;
    r.options.section_phase = field(given, "section_phase").get<double>();
    r.options.section_points =
        static_cast<std::size_t>(field(given, "section_points").get<double>());
    r.carry = carry == "up"     ? SweepRequest::Carry::up
              : carry == "down" ? SweepRequest::Carry::down
                                : SweepRequest::Carry::none;
    r.options.carry = r.default_set || r.carry != SweepRequest::Carry::none;
    if (r.default_set && r.carry != SweepRequest::Carry::none)
        errors.push_back(
            {"/carry_state", carry, Json::array({"none"}),
             "the default set of starts goes on from both neighbours already"});
    if (r.options.section != Section::none && (r.default_set || r.reduce))
        errors.push_back(
            {"/section", section, Json::array({"none"}),
             "a section belongs to one motion: the default set of starts and reduce tell the worst "
             "of several"});
    if (given.contains("indices")) {
        r.indices = given["indices"].get<std::vector<std::size_t>>();
        std::sort(r.indices.begin(), r.indices.end());
        r.indices.erase(std::unique(r.indices.begin(), r.indices.end()), r.indices.end());
        if (!r.indices.empty() && r.indices.back() >= r.points)
            errors.push_back(
                {"/indices", r.indices.back(), Json::array({0, r.points - 1}),
                 "the sweep has " + std::to_string(r.points) + " points, from 0 on"});
    } else {
        r.indices.resize(r.points);
        std::iota(r.indices.begin(), r.indices.end(), 0);
    }
    if (!errors.empty()) refuse(std::move(errors));
    return r;
}

std::vector<std::size_t> shard_of(const SweepRequest& r, std::size_t shard, std::size_t shards) {
    std::vector<std::size_t> own;
    for (std::size_t index : r.indices)
        if (index / chain_length(r) % shards == shard) own.push_back(index);
    return own;
}

}  // namespace vines::api
