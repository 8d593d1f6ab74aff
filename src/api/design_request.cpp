#include "api/design.hpp"

#include <fmt/format.h>

#include <numbers>

#include "api/cancellation.hpp"
#include "api/schema/enum_names.hpp"

namespace vines::api {

namespace {

constexpr double least_b_of_amplitude = 0.05, most_b_of_amplitude = 1.2;
constexpr Excitation excitations[] = {
    {"acceleration", "m/s^2", "x_max", "over the band"},
    {"F", "m", "x_max", "over the band"},
    {"initial_velocity", "m/s", "decay_time", "after this impulse"},
    {"load_factor", "", "x_relative_max", "under this load"}};
constexpr Range amplitude_range{1e-9, 1e6}, f_range{1e-3, 1e5}, b_range{1e-9, 1e3};

FieldError outside(
    const Range& range, const char* name, const std::string& where, const Json& value) {
    return {
        where, value, Json::array({range.minimum, range.maximum}),
        fmt::format("{} must lie in [{}, {}]", name, range.minimum, range.maximum)};
}

/// A checked interval within a range.
Interval interval_of(
    const Json& given, const char* name, const Range& range, std::vector<FieldError>& errors) {
    const Interval i = given[name];
    if (!(i.from >= range.minimum && i.to <= range.maximum))
        errors.push_back(outside(range, name, std::string("/") + name, given[name]));
    return i;
}

std::vector<double> numbers_within(
    const Json& list, const char* name, const Range& range, std::vector<FieldError>& errors) {
    if (list.empty() || list.size() > 100)
        errors.push_back(
            {std::string("/") + name, list.size(), Json::array({1, 100}),
             fmt::format("{} must hold 1 to 100 numbers", name)});
    for (std::size_t k = 0; k < list.size(); ++k)
        if (const double v = list[k].get<double>(); !(v >= range.minimum && v <= range.maximum))
            errors.push_back(outside(range, name, fmt::format("/{}/{}", name, k), v));
    return list.get<std::vector<double>>();
}

/// The host; what the design chooses or sweeps must not be given. A reduced one becomes that with
/// m1 = 1 kg and k1 = 1 N/m, whose unit of time is 1 s.
void read_host(DesignRequest& r, const Json& given, std::vector<FieldError>& errors) {
    const Json& base = given["base"];
    for (const std::string& name : present(
             base, {"f", "F", "acceleration", "Omega", "G", "b", "R", "R_plus", "R_minus",
                    "gravity", "inclination", "friction", "mu", "restitution", "restitution_plus",
                    "restitution_minus", "forcing", "preset"}))
        errors.push_back(
            {"/base/" + name, base[name], nullptr,
             name + " is no field of a host: a design chooses b and R, and gives f and "
                    "acceleration or F, forcing or initial_velocity beside base"});
    if (!errors.empty()) return;
    const auto take = [&](const std::vector<FieldError>& found) {
        for (const FieldError& e : found)
            add_errors(e.pointer.starts_with("/forcing") ? "" : "/base", {e}, errors);
    };
    try {
        Json whole = base;
        if (base.contains("epsilon") || base.contains("lambda")) {
            const StartedSystem reduced = read_started_system(base);
            take(reduced.errors);
            if (!errors.empty()) return;
            const Parameters& p = reduced.system.parameters;
            whole.erase("epsilon"), whole.erase("lambda");
            whole.update({{"m1", 1}, {"k1", 1}, {"c1", p.epsilon * p.lambda}, {"m2", p.epsilon}});
        }
        if (given.contains("forcing")) whole["forcing"] = given["forcing"];
        else whole.update({{"f", given.contains("f") ? given["f"][0] : Json(1)}, {"F", 1e-3}});
        // The masses to choose from stand for that of the base.
        if (given.contains("m2") && !given["m2"].empty())
            whole.erase("mass_ratio"), whole["m2"] = given["m2"][0];
        const StartedSystem host = read_started_system(whole);
        take(host.errors);
        r.host = *host.system.si;
        r.plan.host.damping = host.system.parameters.damping;
        if (given.contains("forcing"))
            r.plan.host.load = [field = std::make_shared<ForcingField>(given["forcing"])](
                                   const SiParameters& si) { return field->load(si); };
    } catch (const Problem& problem) {
        take(problem.errors);
    }
}

/// A design has one kind of load: f with acceleration or F, forcing, or initial_velocity.
void add_load_errors(const Json& given, std::vector<FieldError>& errors) {
    for (const std::string& own : present(given, {"forcing", "initial_velocity"})) {
        for (const std::string& name :
             present(given, {"f", "acceleration", "F", "starts", "initial_velocity"}))
            if (name != own)
                errors.push_back(
                    {"/" + name, given[name], nullptr,
                     name + " must not be given together with " + own});
        return;
    }
    if (!given.contains("f"))
        errors.push_back(
            {"/f", nullptr, nullptr, "a design needs f, or forcing or initial_velocity"});
    if (given.contains("acceleration") == given.contains("F"))
        errors.push_back(
            {"/acceleration", nullptr, nullptr, "a design needs either acceleration or F"});
}

/// The checked request without what was given as a number in place of a list.
Json with_lists(const Json& object) {
    Json given = object;
    for (const char* name : {"R", "m2"})
        if (given.contains(name) && given[name].is_number())
            given[name] = Json::array({given[name]});
    Json checked = given;
    for (const Field& f : design_fields()) {
        if (f.type != FieldType::interval || !given.contains(f.name)) continue;
        // One number in a query or on the command line is a list of one.
        Json& value = given[f.name];
        if (value.is_array() && value.size() == 1) checked[f.name] = value = Json(value[0]);
        if (!value.is_number()) continue;
        value = Json::array({value, value});
        checked.erase(f.name);
    }
    std::vector<FieldError> errors = check(design_fields(), checked);
    if (!given.contains("base"))
        errors.push_back({"/base", nullptr, nullptr, "a design needs a base"});
    add_load_errors(given, errors);
    refuse_any(errors);
    return given;
}

/// A checked distribution; errors are relative to the tolerances.
Tolerance read_tolerance(
    Toleranced what, const std::string& name, const Json& given, std::vector<FieldError>& errors) {
    const bool is_normal = given.contains("normal"), is_factor = given.value("of", "") == "factor";
    const Json& pair = given.value(is_normal ? "normal" : "uniform", Json::array());
    if (is_normal == given.contains("uniform") || pair.size() != 2) {
        errors.push_back(
            {"/" + name, given, nullptr,
             "a distribution is normal, [mean, standard deviation], or uniform, [from, to]"});
        return {};
    }
    const double first = pair[0], second = pair[1],
                 most = what == Toleranced::R && !is_factor ? 1 : infinity;
    if (!(first >= 0 && second >= 0 && (is_normal ? first : second) <= most))
        errors.push_back(
            {"/" + name, pair, nullptr,
             "values and standard deviations are not negative, and R is at most 1"});
    return {what, is_normal, is_factor, first, second};
}

void read_tolerances(DesignRequest& r, const Json& given, std::vector<FieldError>& errors) {
    const Json all = given.value("tolerances", Json::object());
    std::vector<FieldError> faults;
    for (const auto& [what, text] : enum_names<Toleranced>) {
        const std::string name = text, own = name_in(r, what);
        if (!all.contains(name)) continue;
        Tolerance t = read_tolerance(what, name, all[name], faults);
        const std::string other = what == Toleranced::f0              ? "k1"
                                  : what == Toleranced::damping_ratio ? "c1"
                                                                      : "";
        if (name != own || all.contains(other))
            faults.push_back(
                {"/" + name, all[name], nullptr,
                 name + " excludes " + (name != own ? own : other)});
        if (what == Toleranced::amplitude && !t.is_factor)
            t.first /= r.amplitude, t.second /= r.amplitude;
        r.plan.tolerances.push_back(t);
    }
    add_errors("/tolerances", std::move(faults), errors);
    if (r.plan.tolerances.empty()) return;
    const WithDefaults field{design_fields(), given};
    const std::size_t count = field["samples"];
    r.plan.seed = field["seed"];
    r.plan.samples = read_indices(given, count, fmt::format("there are {} samples", count), errors);
}

/// The largest x without absorber, m. Throws Cancelled.
double largest_without(const DesignPlan& plan, const std::function<bool()>& gives_up) {
    const LinearResponse linear = linear_response_of(plan, Objective::x_max, gives_up);
    try {
        return band_maximum([&](double f) { return linear({}, f); }, plan.f).value;
    } catch (const Stopped&) {
        throw Cancelled();
    }
}

}  // namespace

const char* name_in(const DesignRequest& r, Toleranced what) {
    return what == Toleranced::amplitude ? r.excitation->amplitude : enum_name(what);
}

DesignRequest read_design_request(const Json& object, const std::function<bool()>& gives_up) {
    const Json given = with_lists(object);
    const WithDefaults field{design_fields(), given};
    DesignRequest r;
    r.given = object;
    std::vector<FieldError> errors;
    DesignPlan& plan = r.plan;
    for (const Excitation& kind : excitations) {
        r.excitation = &kind;
        if (!given.contains(kind.amplitude)) continue;
        const Interval i = interval_of(given, kind.amplitude, amplitude_range, errors);
        r.amplitude = i.to, plan.amplitude_ratio = i.from / i.to;
        break;
    }
    const bool harmonic = given.contains("f");
    if (harmonic) {
        plan.f = interval_of(given, "f", f_range, errors);
        plan.host.base_amplitude = [a = r.amplitude,
                                    is = given.contains("acceleration")](double f) {
            const double omega = 2 * std::numbers::pi * f;
            return is ? a / (omega * omega) : a;
        };
    } else if (given.contains("initial_velocity")) plan.host.initial_velocity = r.amplitude;
    plan.R = numbers_within(field["R"], "R", {0, 1}, errors);
    if (errors.empty()) read_host(r, given, errors);
    refuse_any(errors);
    plan.m2 = given.contains("m2")
                  ? numbers_within(given["m2"], "m2", {1e-9 * r.host.m1, 10 * r.host.m1}, errors)
                  : std::vector{r.host.m2};
    refuse_any(errors);
    plan.host.si = r.host;
    plan.transient_cycles = field["transient_cycles"];
    plan.cycles = field["cycles"];
    if (given.contains("b")) plan.b = interval_of(given, "b", b_range, errors);
    else {
        const double most = largest_without(plan, gives_up);
        if (!(most > 0)) refuse(harmonic ? "/base" : "/forcing", "nothing moves the host");
        plan.b = {least_b_of_amplitude * most, most_b_of_amplitude * most};
    }
    read_tolerances(r, given, errors);
    refuse_any(errors);
    r.objective = given.value("objective", r.excitation->objective);
    plan.objective = enum_value<Objective>(r.objective);
    plan.mean = field["over"] == "mean";
    if (r.objective == "decay_time" && plan.host.initial_velocity == 0)
        refuse("/objective", "decay_time needs initial_velocity");
    plan.default_set = harmonic && field["starts"] != "one";
    plan.b_count = plan.b.from < plan.b.to ? field["b_count"].get<int>() : 1;
    plan.f_count = harmonic ? field["f_count"].get<int>() : 1;
    return r;
}

}  // namespace vines::api
