#include "api/continuation.hpp"

#include <algorithm>
#include <atomic>
#include <numbers>

#include "api/describe.hpp"
#include "api/json_text.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace {

// Newton's method for a stated orbit may move the start by this, in units of the motion.
constexpr double stated_reach = 0.5;
constexpr int depth_of_true = 2;

/// The parameter's value in the base: given, of its preset, or the default.
std::optional<double> value_in(const SystemFields& fields, const std::string& parameter) {
    if (fields.has(parameter)) return fields.number(parameter);
    const ResolvedSystem system = resolve(fields);
    Json values = describe(properties::reduced, system.parameters);
    values["R"] = system.parameters.R_plus;
    if (system.si) {
        const double omega = 2 * std::numbers::pi * system.si->f;
        values.update(describe(properties::si, *system.si));
        values.update(describe(properties::derived_si, *system.si));
        values["acceleration"] = system.si->F * omega * omega;
        if (system.parameters.gravity == 0) values["inclination"] = 0;
        if (system.parameters.friction == 0) values["mu"] = 0;
    }
    if (!values.contains(parameter)) return std::nullopt;
    return values[parameter].get<double>();
}

std::function<std::optional<Parameters>(const std::vector<double>&)> systems_along(
    const SystemFields& fields, const std::vector<std::string>& parameters) {
    return [fields, parameters](const std::vector<double>& values) {
        SystemFields changed = fields;
        for (std::size_t i = 0; i < parameters.size(); ++i)
            changed.numbers[parameters[i]] = values[i];
        const Parameters p = resolve(changed).parameters;
        const bool valid = validate(p, default_state(p)).empty();
        return valid ? std::optional(p) : std::nullopt;
    };
}

/// Why a branch ends, as a word and as a sentence; in the order of BranchEnd.
struct EndText {
    const char *word, *sentence;
};
constexpr EndText end_texts[] = {
    {"range", "the parameter reaches the end of its range"},
    {"grazing", "a grazing contact: no orbit with one impact more or less continues the branch"},
    {"last_impact", "the last impacts become grazing contacts"},
    {"stick", "a phase of sticking or sliding begins or ends, and no orbit is found beyond it"},
    {"parent",
     "the branch meets the orbit from which it branches; beyond are its mirror images or shifted "
     "copies"},
    {"closed", "the branch returns to its first orbit"},
    {"points", "the limit of points is reached"},
    {"impacts", "the limit of impacts per period is reached"},
    {"not_decided", "not decided: Newton's method does not converge, however short the step"}};
static_assert(std::size(end_texts) == static_cast<std::size_t>(BranchEnd::not_decided) + 1);

/// The special points of a kind, instead of lines.
struct PointsOfKind : BranchSink {
    explicit PointsOfKind(SpecialKind wanted) : kind(wanted) {}
    void point(int, const OrbitPoint&) override {}
    void special(int, const SpecialPoint& special) override {
        if (special.kind == kind && special.on.equations) found.push_back(special);
    }
    const SpecialKind kind;
    std::vector<SpecialPoint> found;
};

class ContinuationLines : public LineStream, BranchSink {
public:
    explicit ContinuationLines(ContinueRequest r) : r_(std::move(r)) {}

    std::string begin() const override {
        const auto& [from, to] = r_.plan.family.ranges[0];
        return json_line(
            {{"type", "start"},
             {"version", version()},
             {"commit", commit()},
             {"parameter", r_.parameter},
             {"from", from},
             {"to", to},
             {"parameters", describe_system(r_.base.system)},
             {"warnings", r_.base.system.notes},
             {"request", r_.given}});
    }
    bool compute(int, RunControl& control, const Take& take) override {
        const ComputePermit permit(control);
        take_ = take;
        bool stopped = false;
        follow([&] { return stopped = stopped || control.stop_or_yield(); });
        ++control.runs;
        complete_ = !stopped;
        return complete_;
    }
    std::string progress(std::size_t, const RunControl&, double seconds) const override {
        const std::size_t done = points_;
        return json_line(
            {{"type", "progress"},
             {"done", done},
             {"per_second", seconds > 0 ? static_cast<double>(done) / seconds : 0}});
    }
    std::string end() override {
        if (!complete_) return "";
        return json_line(
            {{"type", "done"},
             {"points", points_.load()},
             {"specials", specials_},
             {"branches", branches_}});
    }
    const char* remedy() const override {
        return "continue from the state of a last point, with orbit \"stated\"";
    }

private:
    void branch(const BranchStart& b) override {
        ++branches_;
        send(
            {{"type", "branch"},
             {"branch", b.number},
             {"from_branch", b.from < 0 ? Json(nullptr) : Json(b.from)},
             {"begins_at", b.at == SpecialKind::end ? "start" : name_of(b.at)},
             {"direction", b.direction > 0 ? "up" : "down"}});
    }
    void point(int branch, const OrbitPoint& point) override {
        ++points_;
        send(place("point", branch, point));
    }
    void special(int branch, const SpecialPoint& s) override {
        ++specials_;
        Json line = place("special", branch, s.orbit);
        line["kind"] = name_of(s.kind);
        if (s.end) {
            const EndText& end = end_texts[static_cast<std::size_t>(*s.end)];
            line.update({{"reason", end.word}, {"detail", end.sentence}});
        }
        if (s.kind == SpecialKind::grazing)
            line["impacts_beyond"] = s.impacts_after > 0 ? Json(s.impacts_after) : Json(nullptr);
        if (s.angle) line["angle"] = *s.angle;
        send(std::move(line));
    }
    /// Reports why the continuation has no first orbit or no point for a curve.
    void no_orbit(const char* reason, const std::string& detail) {
        ++specials_;
        send(
            {{"type", "special"},
             {"branch", nullptr},
             {r_.parameter, r_.at},
             {"kind", "end"},
             {"reason", reason},
             {"detail", detail}});
    }
    Json place(const char* type, int branch, const OrbitPoint& point) const {
        Json line = {{"type", type}, {"branch", branch}, {r_.parameter, point.parameters[0]}};
        if (point.parameters.size() > 1) line[r_.second] = point.parameters[1];
        line.update(describe(properties::branch_point, point));
        line["multipliers"] = describe_multipliers(point.multipliers);
        line["state"] = describe(properties::start, point.measures.at_whole_cycle);
        return line;
    }
    void send(Json line) const { take_(json_line(std::move(line))); }

    /// The orbit on which the base settles, or that it states; otherwise reports why there is none.
    std::optional<PeriodicOrbit> first_orbit(const vines::StopRequest& stop) {
        const Parameters& p = r_.base.system.parameters;
        std::optional<PeriodicOrbit> orbit;
        if (r_.settles) {
            const PointResult settled = measure(p, r_.base.start, r_.settling, stop);
            if (stop()) return std::nullopt;
            if (settled.measured) orbit = settled.regime.orbit;
        } else {
            const State& s = r_.base.start;
            orbit = find_orbit(p, s, r_.period_cycles, scale_of(p, {&s, 1}), stated_reach, stop);
        }
        if (!orbit)
            no_orbit(
                "no_orbit",
                r_.settles
                    ? "the base does not settle on a periodic orbit within cycles; state one: "
                      "orbit \"stated\" with its state as start"
                    : "Newton's method finds no orbit of period_cycles next to the start");
        else if (orbit->impacts == 0)
            no_orbit("no_impacts", "the first orbit has no impacts: there is nothing to follow");
        else return orbit;
        return std::nullopt;
    }
    void follow(const vines::StopRequest& stop) {
        const auto orbit = first_orbit(stop);
        if (!orbit) return;
        const Parameters& p = r_.base.system.parameters;
        const double length = scale_of(p, whole_cycle_states(p, *orbit)).x;
        const auto start = orbit_start(p, *orbit, length, r_.plan.family, {r_.at});
        r_.plan.stop = stop;
        if (!start)
            no_orbit("not_decided", "not decided: the first orbit's impacts are not periodic");
        else if (r_.curve) follow_curves(*start);
        else follow_branches(r_.plan, *start, *this);
    }
    /// Curves through the special points of the branch.
    void follow_curves(const OrbitGuess& start) {
        PointsOfKind points(*r_.curve);
        if (!follow_branches(r_.plan, start, points)) return;
        if (points.found.empty())
            no_orbit("no_such_point", "the branch has no special point of the kind of curve");
        BranchPlan curve = r_.plan;
        curve.family = r_.curve_family;
        int number = 0;
        for (const SpecialPoint& point : points.found) {
            if (!follow_curve(curve, point, r_.second_at, number, *this)) return;
            number += 2;
        }
    }

    ContinueRequest r_;
    Take take_;
    std::atomic<std::size_t> points_ = 0;
    std::size_t specials_ = 0, branches_ = 0;
    bool complete_ = false;
};

/// Refuses ends of a range that do not enclose the base's value `at`, or form no valid system.
void check_range(
    const SystemFields& fields, const std::string& parameter, double at, const Json& given,
    const std::string& from, const std::string& to, std::vector<FieldError>& errors) {
    const auto [least, largest] = std::minmax({given[from].get<double>(), given[to].get<double>()});
    if (least == largest || at < least || at > largest)
        errors.push_back(
            {"/" + from, given[from].get<double>(), Json::array({at, given[to].get<double>()}),
             from + " and " + to + " must differ and enclose the base's " + parameter});
    for (const std::string& end : {from, to}) {
        if (systems_along(fields, {parameter})({given[end]})) continue;
        Json whole = given.value("base", Json::object());
        whole[parameter] = given[end];
        for (const FieldError& e : faults_of_base(whole))
            errors.push_back({"/" + end, given[end], e.range, e.detail});
    }
}

void read_curve(ContinueRequest& r, const Json& given, const SystemFields& fields) {
    for (const char* name : {"second", "second_from", "second_to"})
        if (!given.contains(name))
            refuse(std::string("/") + name, "a curve needs second, second_from and second_to");
    int kind = 0;
    while (given["curve"] != name_of(static_cast<SpecialKind>(kind))) ++kind;
    r.curve = static_cast<SpecialKind>(kind);
    r.second = given["second"];
    const std::vector<std::string> names = continued_names();
    const bool known = std::ranges::find(names, r.second) != names.end();
    const auto at = known ? value_in(fields, r.second) : std::nullopt;
    if (!at || r.second == r.parameter)
        refuse({{"/second", r.second, names, "second must be another parameter of the base"}});
    std::vector<FieldError> errors;
    check_range(fields, r.second, *at, given, "second_from", "second_to", errors);
    refuse_any(errors);
    const double from = given["second_from"], to = given["second_to"];
    r.second_at = *at;
    r.curve_family = {
        systems_along(fields, {r.parameter, r.second}), {r.plan.family.ranges[0], {from, to}}};
}

/// Its parameter, its base and the range of the parameter. Returns the fields of the base's system.
SystemFields read_family(ContinueRequest& r, const Json& given) {
    r.parameter = given["parameter"];
    const std::vector<std::string> names = continued_names();
    if (std::ranges::find(names, r.parameter) == names.end())
        refuse(
            {{"/parameter", r.parameter, names, "there is no parameter of this name to continue"}});
    const Json base = given.value("base", Json::object());
    std::vector<FieldError> errors;
    add_errors("/base", check(sweep_base_fields(), base), errors);
    refuse_any(errors);
    SystemFields fields = system_fields(merge_with_preset(sweep_base_fields(), base).fields);
    const auto at = value_in(fields, r.parameter);
    if (!at)
        refuse(
            "/base",
            r.parameter == "inclination" && fields.has("gravity")
                ? "the base states its gravity: continue along gravity, or state the "
                  "inclination instead"
            : r.parameter == "mu" && fields.has("friction")
                ? "the base states its friction: continue along friction, or state mu instead"
                : r.parameter + " is a parameter of a system in SI: the base must be one, too");
    r.at = *at;
    Json whole = base;
    whole[r.parameter] = r.at;
    r.base = read_started_system(whole);
    add_errors("/base", r.base.errors, errors);
    if (r.base.system.parameters.load)
        errors.push_back(
            {"/base", nullptr, nullptr, "orbits are continued for a harmonic forcing"});
    check_range(fields, r.parameter, r.at, given, "from", "to", errors);
    refuse_any(errors);
    return fields;
}

}  // namespace

ContinueRequest read_continue_request(const Json& object) {
    Json given = object;
    if (given.contains("switch") && given["switch"].is_boolean())
        given["switch"] = given["switch"].get<bool>() ? depth_of_true : 0;
    std::vector<FieldError> errors = check(continue_fields(), given);
    for (const char* name : {"parameter", "from", "to"})
        if (!given.contains(name))
            errors.push_back(
                {std::string("/") + name, nullptr, nullptr,
                 "a continuation needs parameter, from and to"});
    refuse_any(errors);

    ContinueRequest r;
    r.given = object;
    const SystemFields fields = read_family(r, given);
    const double from = given["from"], to = given["to"];
    const WithDefaults field{continue_fields(), given};
    r.plan = {
        .family = {systems_along(fields, {r.parameter}), {{from, to}}},
        .resolution = field["resolution"],
        .most_points = field["points"],
        .switches = field["switch"]};
    if (given.contains("curve")) read_curve(r, given, fields);
    r.settles = field["orbit"] == "settled";
    r.period_cycles = field["period_cycles"];
    r.settling = {
        .transient_cycles = field["transient_cycles"],
        .cycles = field["cycles"],
        .max_impacts = r.base.max_impacts};
    return r;
}

std::shared_ptr<LineStream> continuation_lines(ContinueRequest request) {
    return std::make_shared<ContinuationLines>(std::move(request));
}

}  // namespace vines::api
