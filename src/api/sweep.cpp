#include "api/sweep.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>

#include "api/describe.hpp"
#include "api/simulate.hpp"

namespace vines::api {

namespace {

/// Errors of a nested object, at their place in the request.
void add_errors(const std::string& where, std::vector<FieldError> errors, std::vector<FieldError>& all) {
    for (FieldError& e : errors) {
        e.pointer = where + e.pointer;
        all.push_back(std::move(e));
    }
}

bool is_parameter(const std::string& name) {
    const auto& fields = sweep_base_fields();
    return std::any_of(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name && f.type == FieldType::number; });
}

std::vector<std::string> parameter_names() {
    std::vector<std::string> names;
    for (const Field& f : sweep_base_fields()) if (f.type == FieldType::number) names.push_back(f.name);
    return names;
}

/// from, ..., to in `count` steps. The ends are exact.
std::vector<double> spaced(double from, double to, std::size_t count, bool logarithmic) {
    std::vector<double> values;
    for (std::size_t i = 0; i < count; ++i) {
        const double share = count > 1 ? static_cast<double>(i) / static_cast<double>(count - 1) : 0;
        values.push_back(logarithmic ? from * std::pow(to / from, share) : from + share * (to - from));
    }
    if (count > 1) values.back() = to;
    return values;
}

Axis read_axis(const Json& j, const std::string& where, std::size_t most, std::vector<FieldError>& errors) {
    Axis axis;
    if (!j.is_object()) {
        errors.push_back({where, j, nullptr, "an axis is {parameter, from, to, count, scale} or {parameter, values}"});
        return axis;
    }
    std::vector<FieldError> own = check(axis_fields(), j);
    if (!j.contains("parameter")) own.push_back({"/parameter", nullptr, parameter_names(), "an axis needs its parameter"});
    else if (j["parameter"].is_string() && !is_parameter(j["parameter"]))
        own.push_back({"/parameter", j["parameter"], parameter_names(), "there is no parameter of this name to sweep"});
    if (j.contains("values")) {
        for (const char* name : {"from", "to", "count", "scale"})
            if (j.contains(name)) own.push_back({std::string("/") + name, j[name], nullptr, "values and from, to, count, scale exclude each other"});
        if (j["values"].is_array()) {
            if (j["values"].empty()) own.push_back({"/values", j["values"], nullptr, "values must hold at least one number"});
            if (j["values"].size() > most) own.push_back({"/values", j["values"].size(), Json::array({1, most}), "values may hold " + std::to_string(most) + " numbers"});
        }
    } else {
        for (const char* name : {"from", "to", "count"})
            if (!j.contains(name)) own.push_back({std::string("/") + name, nullptr, nullptr, "an axis needs from, to and count, or values"});
    }
    const bool logarithmic = own.empty() && j.value("scale", "linear") == "log";
    if (logarithmic && !(j["from"].get<double>() > 0 && j["to"].get<double>() > 0))
        own.push_back({j["from"].get<double>() > 0 ? "/to" : "/from", j[j["from"].get<double>() > 0 ? "to" : "from"], nullptr, "a logarithmic axis runs between positive numbers"});
    if (own.empty()) {
        axis.parameter = j["parameter"];
        axis.values = j.contains("values") ? j["values"].get<std::vector<double>>()
                                           : spaced(j["from"].get<double>(), j["to"].get<double>(), static_cast<std::size_t>(j["count"].get<double>()), logarithmic);
    }
    add_errors(where, std::move(own), errors);
    return axis;
}

/// A field of the request, or the table's default.
Json field(const Json& object, const char* name) {
    if (object.contains(name)) return object[name];
    for (const Field& f : sweep_fields()) if (f.name == name) return f.fallback;
    return nullptr;
}

/// Where a point lies: along the first axis, the second, and which start. The first axis counts fastest.
struct Place {
    std::size_t first, second, start;
};
Place place_of(const SweepRequest& r, std::size_t index) {
    const std::size_t n = r.axes[0].values.size();
    const std::size_t row = index / n;
    return {index % n, row / r.starts.size(), row % r.starts.size()};
}

/// The fields of a point: base, then its start, then its values.
Json fields_of(const SweepRequest& r, const Place& place) {
    Json object = r.base;
    object.update(r.starts[place.start]);
    object[r.axes[0].parameter] = r.axes[0].values[place.first];
    if (r.axes.size() > 1) object[r.axes[1].parameter] = r.axes[1].values[place.second];
    return object;
}

/// The corners of the sweep must be valid systems; each point is checked again when its turn comes.
void check_corners(const SweepRequest& r, std::vector<FieldError>& errors) {
    const std::size_t n0 = r.axes[0].values.size(), n1 = r.axes.size() > 1 ? r.axes[1].values.size() : 1;
    for (std::size_t start = 0; start < r.starts.size(); ++start) {
        for (std::size_t first : {std::size_t{0}, n0 - 1}) {
            for (std::size_t second : {std::size_t{0}, n1 - 1}) {
                try {
                    read_started_system(fields_of(r, {first, second, start}));
                } catch (const Problem& problem) {
                    for (FieldError e : problem.errors) {
                        std::string at = "/base" + e.pointer;
                        for (std::size_t a = 0; a < r.axes.size(); ++a) if (e.pointer == "/" + r.axes[a].parameter) at = "/axes/" + std::to_string(a);
                        if (r.starts[start].contains(e.pointer.substr(1))) at = "/starts/" + std::to_string(start) + e.pointer;
                        const bool known = std::any_of(errors.begin(), errors.end(), [&](const FieldError& other) { return other.pointer == at && other.value == e.value; });
                        if (!known) errors.push_back({at, e.value, e.range, e.detail});
                    }
                }
            }
        }
    }
}

/// Where a point lies, and what was found there or what is wrong with it.
Json located(const SweepRequest& r, std::size_t index) {
    const Place place = place_of(r, index);
    Json line = {{"type", "point"}, {"index", index}};
    line[r.axes[0].parameter] = r.axes[0].values[place.first];
    if (r.axes.size() > 1) line[r.axes[1].parameter] = r.axes[1].values[place.second];
    if (r.starts.size() > 1) line["start"] = place.start;
    return line;
}

// What a point's line says of its motion: null where there was none to measure.
constexpr const char* measured_quantities[] = {"lambda", "status", "standard_error", "verdict", "z", "regime", "periodic", "period_cycles", "impacts_per_period", "symmetric",
                                               "capture_cycle", "multiplier", "synchronised", "x_max", "x_rms", "x_rms_ratio", "share_impacts", "impacts", "sticks"};

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
        j["time_difference"] = column([](const auto& p) { return finite_or_null(p.time_difference); });
    } else {
        j["x"] = column([](const auto& p) { return p.x; });
        j["x_dot"] = column([](const auto& p) { return p.x_dot; });
        j["y"] = column([](const auto& p) { return p.y; });
        j["y_dot"] = column([](const auto& p) { return p.y_dot; });
    }
    return j;
}

/// `afresh`: the point was to go on from its neighbour's last state, but there was none at a whole cycle.
Json describe_point(const SweepRequest& r, std::size_t index, double cycle, const PointResult& p, bool afresh) {
    Json line = located(r, index);
    if (afresh) line["carried"] = false;
    if (!p.measured) {
        for (const char* name : measured_quantities) line[name] = nullptr;
        line["reason"] = "transient_max_impacts";
        return line;
    }
    line["lambda"] = Json::array();
    line["status"] = Json::array();
    for (double v : p.lambda) {
        line["lambda"].push_back(finite_or_null(v));
        line["status"].push_back(word(status_of(v)));
    }
    line["standard_error"] = finite_or_null(p.standard_error[0]);
    line["verdict"] = word(p.verdict);
    line["z"] = p.regime.z;
    line["regime"] = name_of(p.regime.type);
    line["periodic"] = p.regime.orbit.has_value();
    line["period_cycles"] = p.regime.orbit ? Json(p.regime.orbit->cycles) : Json(nullptr);
    line["impacts_per_period"] = p.regime.orbit ? Json(p.regime.orbit->contacts) : Json(nullptr);
    line["symmetric"] = p.regime.orbit ? Json(p.regime.orbit->symmetric) : Json(nullptr);
    line["capture_cycle"] = p.regime.capture && p.regime.capture->tau ? Json(std::round(*p.regime.capture->tau / cycle)) : Json(nullptr);
    line["multiplier"] = p.regime.orbit ? Json(std::abs(p.regime.orbit->multipliers[0])) : Json(nullptr);
    line["synchronised"] = p.regime.synchronised;
    line["x_max"] = p.x_max;
    line["x_rms"] = p.x_rms;
    line["x_rms_ratio"] = finite_or_null(p.x_rms_ratio);
    line["share_impacts"] = finite_or_null(p.share_impacts);
    line["impacts"] = p.impacts;
    line["sticks"] = p.sticks;
    line["reason"] = p.outcome.reason == End::tau_end ? "complete" : "max_impacts";
    if (r.options.section != Section::none) line["section"] = describe_section_points(p.section, r.options.section);
    return line;
}

/// Points that follow from each other: a row of the first axis where state is carried, in the order of computing, else one.
std::size_t chain_length(const SweepRequest& r) { return r.carry == SweepRequest::Carry::none ? 1 : r.axes[0].values.size(); }

struct Stopped {};

class Sweep {
public:
    Sweep(const SweepRequest& r, Pace& pace, const std::function<void(std::size_t, const Json&)>& point) : r_(r), pace_(pace), point_(point) {}

    /// The wanted points of one chain, in the order of their index.
    void run_chain(std::span<const std::size_t> wanted) {
        if (r_.carry == SweepRequest::Carry::none) {
            run_point(wanted[0], std::nullopt, true, true);
            return;
        }
        const std::size_t n = r_.axes[0].values.size(), row = wanted[0] / n * n;
        std::optional<Carried> before;
        std::size_t left = wanted.size();
        for (std::size_t k = 0; k < n && left > 0; ++k) {
            const std::size_t index = row + (r_.carry == SweepRequest::Carry::up ? k : n - 1 - k);
            const bool is_wanted = std::binary_search(wanted.begin(), wanted.end(), index);
            before = run_point(index, before, k == 0, is_wanted);
            left -= is_wanted;
        }
    }

private:
    struct Carried {
        Parameters parameters;
        State state;
    };

    /// `first` of its chain, where it starts afresh anyway.
    std::optional<Carried> run_point(std::size_t index, const std::optional<Carried>& before, bool first, bool wanted) {
        struct Turn {
            Pace& pace;
            explicit Turn(Pace& p) : pace(p) { pace.begin(); }
            ~Turn() { pace.end(); }
        } const turn(pace_);
        if (pace_.stop_or_yield()) throw Stopped();
        try {
            const StartedSystem s = read_started_system(fields_of(r_, place_of(r_, index)));
            const Parameters& p = s.system.parameters;
            PointOptions options = r_.options;
            options.max_impacts = s.max_impacts;
            const PointResult result = measure(p, before ? carried(before->state, before->parameters, p) : s.start, options, [this] { return pace_.stop_or_yield(); });
            if (result.outcome.reason == End::stopped || pace_.stop_or_yield()) throw Stopped();
            if (wanted) emit(index, describe_point(r_, index, p.cycle(), result, !first && !before));
            if (!result.at_end) return std::nullopt;  // no state at a whole cycle: the next point starts afresh, and its line says so
            return Carried{p, *result.at_end};
        } catch (const Problem& problem) {  // inside the corners, but no system of its own
            Json line = located(r_, index);
            line["error"] = problem.what();
            if (wanted) emit(index, line);
            return before;
        }
    }

    void emit(std::size_t index, const Json& line) {
        const std::lock_guard lock(emitting_);
        point_(index, line);
    }

    const SweepRequest& r_;
    Pace& pace_;
    const std::function<void(std::size_t, const Json&)>& point_;
    std::mutex emitting_;
};

}  // namespace

SweepRequest read_sweep_request(const Json& given, std::size_t most_points) {
    std::vector<FieldError> errors = check(sweep_fields(), given);
    if (!given.contains("axes")) errors.push_back({"/axes", nullptr, nullptr, "a sweep needs axes: one or two of {parameter, from, to, count} or {parameter, values}"});
    if (!errors.empty()) refuse(std::move(errors));

    SweepRequest r;
    r.given = given;
    r.given.erase("indices");
    r.base = field(given, "base");
    const Json& axes = given["axes"];
    if (axes.empty() || axes.size() > 2) errors.push_back({"/axes", axes.size(), Json::array({1, 2}), "a sweep has one or two axes"});
    for (std::size_t i = 0; i < std::min<std::size_t>(axes.size(), 2); ++i) r.axes.push_back(read_axis(axes[i], "/axes/" + std::to_string(i), most_points, errors));
    if (r.axes.size() == 2 && !r.axes[0].parameter.empty() && r.axes[0].parameter == r.axes[1].parameter)
        errors.push_back({"/axes/1/parameter", r.axes[1].parameter, nullptr, "both axes have the same parameter"});
    add_errors("/base", check(sweep_base_fields(), r.base), errors);
    const Json starts = field(given, "starts");
    for (std::size_t i = 0; i < starts.size() && errors.size() < most_errors; ++i) {
        const std::string where = "/starts/" + std::to_string(i);
        if (starts[i].is_object()) add_errors(where, check(start_fields(), starts[i]), errors);
        else errors.push_back({where, starts[i], nullptr, "a start is {x0, x_dot0, y0, y_dot0}"});
        r.starts.push_back(starts[i]);
    }
    if (r.starts.empty()) r.starts.push_back(Json::object());
    for (const Axis& a : r.axes)
        if (r.base.contains(a.parameter)) errors.push_back({"/base/" + a.parameter, r.base[a.parameter], nullptr, a.parameter + " is swept; the base must not set it"});
    if (!errors.empty()) refuse(std::move(errors));

    r.points = r.starts.size();
    for (const Axis& a : r.axes) r.points *= a.values.size();
    if (r.points > most_points)
        refuse({{"/axes", r.points, Json::array({1, most_points}), "the sweep has " + std::to_string(r.points) + " points; at most " + std::to_string(most_points) + " are computed at once"}});
    check_corners(r, errors);
    r.options.cycles = field(given, "cycles").get<double>();
    r.options.transient_cycles = field(given, "transient_cycles").get<double>();
    const std::string section = field(given, "section"), carry = field(given, "carry_state");
    r.options.section = section == "impact" ? Section::impact : section == "stroboscopic" ? Section::stroboscopic : Section::none;
    r.options.carry = carry != "none";
    r.options.section_points = static_cast<std::size_t>(field(given, "section_points").get<double>());
    r.carry = carry == "up" ? SweepRequest::Carry::up : carry == "down" ? SweepRequest::Carry::down : SweepRequest::Carry::none;
    if (given.contains("indices")) {
        r.indices = given["indices"].get<std::vector<std::size_t>>();
        std::sort(r.indices.begin(), r.indices.end());
        r.indices.erase(std::unique(r.indices.begin(), r.indices.end()), r.indices.end());
        if (!r.indices.empty() && r.indices.back() >= r.points)
            errors.push_back({"/indices", r.indices.back(), Json::array({0, r.points - 1}), "the sweep has " + std::to_string(r.points) + " points, from 0 on"});
    } else {
        r.indices.resize(r.points);
        std::iota(r.indices.begin(), r.indices.end(), 0);
    }
    if (!errors.empty()) refuse(std::move(errors));
    return r;
}

Json sweep_start(const SweepRequest& r) {
    Json axes = Json::array();
    for (const Axis& a : r.axes) axes.push_back({{"parameter", a.parameter}, {"values", a.values}});
    return {{"type", "start"}, {"version", version()}, {"points", r.points},
            {"cycles", static_cast<double>(r.points) * (r.options.cycles + r.options.transient_cycles)}, {"axes", std::move(axes)}, {"request", r.given}};
}

void run_sweep(const SweepRequest& r, int threads, Pace& pace, const std::function<void(std::size_t, const Json&)>& point) {
    // The wanted points, chain by chain.
    std::vector<std::span<const std::size_t>> chains;
    for (std::size_t from = 0, to; from < r.indices.size(); from = to) {
        const std::size_t chain = r.indices[from] / chain_length(r);
        for (to = from + 1; to < r.indices.size() && r.indices[to] / chain_length(r) == chain;) ++to;
        chains.emplace_back(r.indices.data() + from, to - from);
    }
    Sweep sweep(r, pace, point);
    try {
        parallel(chains.size(), threads, [&](std::size_t i) { sweep.run_chain(chains[i]); });
    } catch (const Stopped&) {
    }
}

std::vector<std::size_t> shard_of(const SweepRequest& r, std::size_t shard, std::size_t shards) {
    std::vector<std::size_t> own;
    for (std::size_t index : r.indices) if (index / chain_length(r) % shards == shard) own.push_back(index);
    return own;
}

}  // namespace vines::api
