#include "api/simulate.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "api/presets.hpp"
#include "core/record.hpp"

namespace vines::api {

namespace {

const std::vector<std::string> reduced_names = {"epsilon", "lambda", "G", "Omega"};
const std::vector<std::string> si_names = {"m1", "c1", "k1", "m2", "F", "f"};
// Which SI fields each reduced one follows from.
const std::map<std::string, std::vector<std::string>> si_origin = {
    {"epsilon", {"m2", "m1"}}, {"lambda", {"c1", "k1", "m1", "m2"}}, {"G", {"F", "m1", "m2"}}, {"Omega", {"f", "k1", "m1"}}};

/// Fields that exclude each other: giving one of each side is a fault, and one of the request's own removes the preset's.
struct Alternative {
    std::vector<std::string> one, other;
    std::string detail;
};
const std::vector<Alternative>& alternatives() {
    static const std::vector<Alternative> list = {
        {reduced_names, si_names, "reduced (epsilon, lambda, G, Omega) and SI (m1, c1, k1, m2, F, f) fields cannot be mixed"},
        {{"R"}, {"R_plus", "R_minus"}, "R stands for both walls and cannot be mixed with R_plus or R_minus"},
        {{"tau_end"}, {"cycles"}, "tau_end and cycles both say how long to run; give one of them"},
    };
    return list;
}

std::vector<std::string> present(const Json& object, const std::vector<std::string>& names) {
    std::vector<std::string> found;
    std::copy_if(names.begin(), names.end(), std::back_inserter(found), [&](const std::string& n) { return object.contains(n); });
    return found;
}

[[noreturn]] void refuse(std::vector<FieldError> errors) {
    const std::string detail = errors.size() == 1             ? errors[0].detail
                               : errors.size() >= most_errors ? "the first " + std::to_string(errors.size()) + " faults are listed"
                                                              : std::to_string(errors.size()) + " fields are at fault";
    throw Problem(422, detail, std::move(errors));
}

void check_alternatives(const Json& object, std::vector<FieldError>& errors) {
    for (const Alternative& a : alternatives()) {
        if (present(object, a.one).empty() || present(object, a.other).empty()) continue;
        for (const auto& names : {a.one, a.other})
            for (const std::string& name : present(object, names)) errors.push_back({"/" + name, object[name], nullptr, a.detail});
    }
}

/// The request's fields over those of its preset.
Json over_preset(const Json& object) {
    if (!object.contains("preset")) return object;
    const std::string name = object["preset"];
    const auto preset = std::find_if(presets().begin(), presets().end(), [&](const Preset& p) { return p.name == name; });
    if (preset == presets().end()) {
        Json names = Json::array();
        for (const Preset& p : presets()) names.push_back(p.name);
        refuse({{"/preset", name, names, "there is no preset of this name; GET /v1/presets lists them"}});
    }
    Json merged = preset->parameters;
    for (const Alternative& a : alternatives())
        for (const auto& [own, others] : {std::pair(a.one, a.other), std::pair(a.other, a.one)})
            if (!present(object, own).empty())
                for (const std::string& other : others) merged.erase(other);
    // A window that was left to the preset makes no sense in a run of another length.
    if (object.contains("tau_end") || object.contains("cycles")) merged.erase("window");
    merged.update(object);
    merged.erase("preset");
    return merged;
}

/// Values by name: the request's, else the table's default.
class Values {
public:
    explicit Values(const Json& object) : object_(object) {}
    bool has(const std::string& name) const { return object_.contains(name); }
    double number(const std::string& name) const { return value(name).get<double>(); }
    double number(const std::string& name, double fallback) const { return has(name) ? object_[name].get<double>() : fallback; }
    std::string word(const std::string& name) const { return value(name).get<std::string>(); }
    bool holds(const std::string& name, const std::string& word) const {
        const Json v = value(name);
        return std::find(v.begin(), v.end(), Json(word)) != v.end();
    }

private:
    const Json& value(const std::string& name) const {
        if (has(name)) return object_[name];
        const auto& fields = simulate_fields();
        return std::find_if(fields.begin(), fields.end(), [&](const Field& f) { return f.name == name; })->fallback;
    }
    const Json& object_;
};

/// A core fault is about a reduced field; where that follows from SI fields, it is they that are at fault.
std::vector<FieldError> field_errors(const std::vector<Fault>& faults, const std::optional<SiParameters>& si, const Json& given) {
    std::vector<FieldError> errors;
    for (const Fault& f : faults) {
        const auto origin = si ? si_origin.find(f.field) : si_origin.end();
        if (origin == si_origin.end()) {
            errors.push_back({"/" + f.field, given.contains(f.field) ? given[f.field] : Json(f.value), Json::array({f.minimum, f.maximum}), f.message});
            continue;
        }
        for (const std::string& name : present(given, origin->second))
            errors.push_back({"/" + name, given[name], nullptr, f.field + " = " + Json(f.value).dump() + " follows from the SI fields; " + f.message});
    }
    return errors;
}

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json describe_parameters(const SimulateRequest& r) {
    const Parameters& p = r.parameters;
    const double zeta = p.zeta();
    Json j = {{"epsilon", p.epsilon}, {"lambda", p.lambda}, {"G", p.G}, {"Omega", p.Omega}, {"R_plus", p.R_plus}, {"R_minus", p.R_minus},
              {"b", p.b}, {"damping", p.damping == Damping::closed_form ? "closed_form" : "equation_of_motion"},
              {"x0", r.start.x}, {"x_dot0", r.start.x_dot}, {"y0", r.start.y}, {"y_dot0", r.start.y_dot},
              {"tau_end", r.tau_end}, {"cycles", r.tau_end * p.Omega / (2 * std::numbers::pi)}, {"window", {r.window_start, r.window_end}},
              {"samples_per_cycle", r.samples_per_cycle}, {"max_points", r.max_points}, {"max_impacts", r.max_impacts}};
    Json derived = {{"zeta", zeta}, {"omega_d", zeta < 1 ? Json(std::sqrt(1 - zeta * zeta)) : Json(nullptr)}, {"A", p.A()}, {"phi", p.phi()},
                    {"cycle", 2 * std::numbers::pi / p.Omega}};
    if (r.si) {
        j["si"] = {{"m1", r.si->m1}, {"c1", r.si->c1}, {"k1", r.si->k1}, {"m2", r.si->m2}, {"F", r.si->F}, {"f", r.si->f}};
        derived["omega0"] = r.si->omega0();
        derived["f0"] = r.si->omega0() / (2 * std::numbers::pi);
    }
    j["derived"] = std::move(derived);
    return j;
}

Json describe_impacts(const std::vector<Impact>& impacts, double epsilon) {
    Json columns = Json::object();
    auto column = [&](const char* name, auto value) {
        Json values = Json::array();
        values.get_ref<Json::array_t&>().reserve(impacts.size());
        for (const Impact& i : impacts) values.push_back(value(i));
        columns[name] = std::move(values);
    };
    column("tau", [](const Impact& i) { return i.tau; });
    column("side", [](const Impact& i) { return i.side; });
    column("phase", [](const Impact& i) { return i.phase(); });
    column("x", [](const Impact& i) { return i.x; });
    column("x_dot_before", [](const Impact& i) { return i.x_dot_before; });
    column("x_dot_after", [](const Impact& i) { return i.x_dot_after; });
    column("y_dot_before", [](const Impact& i) { return i.y_dot_before; });
    column("y_dot_after", [](const Impact& i) { return i.y_dot_after; });
    column("impulse", [&](const Impact& i) { return i.impulse(epsilon); });
    column("grazing", [](const Impact& i) { return i.grazing; });
    return columns;
}

Json describe_sticks(const std::vector<StickRecord::Stick>& sticks) {
    Json side = Json::array(), start = Json::array(), end = Json::array(), impacts = Json::array();
    for (const auto& s : sticks) {
        side.push_back(s.start.side);
        start.push_back(s.start.tau);
        end.push_back(s.tau_end);
        impacts.push_back(s.start.impacts);
    }
    return {{"side", side}, {"tau_start", start}, {"tau_end", end}, {"impacts", impacts}};
}

Json describe_touches(const std::vector<TouchRecord::Touch>& touches) {
    Json tau = Json::array(), side = Json::array();
    for (const auto& t : touches) {
        tau.push_back(t.tau);
        side.push_back(t.side);
    }
    return {{"tau", tau}, {"side", side}};
}

const char* status_word(Status status) {
    switch (status) {
        case Status::ok: return "ok";
        case Status::minus_infinity: return "minus_infinity";
        case Status::not_converged: return "not_converged";
    }
    return "";
}

Json four(const Exponents& values) {
    Json array = Json::array();
    for (double v : values) array.push_back(finite_or_null(v));
    return array;
}

Json describe_estimator(const Exponents& final, const ExponentHistory& history) {
    Json status = Json::array(), columns = {{"tau", history.tau}};
    for (double v : final) status.push_back(status_word(status_of(v)));
    for (std::size_t k = 0; k < 4; ++k) {
        Json values = Json::array();
        for (const Exponents& lambda : history.lambda) values.push_back(finite_or_null(lambda[k]));
        columns["lambda" + std::to_string(k + 1)] = std::move(values);
    }
    return {{"final", four(final)}, {"status", std::move(status)}, {"history", std::move(columns)}};
}

Json describe_exponents(const TransferProduct& product, const SimulateRequest& r, std::vector<std::string>& warnings) {
    const double start = product.start_tau(), T = product.end_tau() - start;
    Json j = {{"window", product.impacts() > 0 ? Json::array({start, product.end_tau()}) : Json(nullptr)}, {"impacts", product.impacts()},
              {"sum_rule_residual", finite_or_null(product.sum_rule_residual(r.parameters.zeta()))}};
    if (r.estimators.qr) {
        Json qr = describe_estimator(product.qr(), product.qr_history());
        qr["standard_error"] = four(standard_error(product.qr_history(), start));
        j["qr"] = std::move(qr);
    }
    if (r.estimators.eigenvalues) j["eigenvalues"] = describe_estimator(product.eigenvalues(), product.eigenvalues_history());
    if (r.estimators.raw_product) {
        const Exponents final = product.raw_product();
        const ExponentHistory& history = product.raw_product_history();
        Json raw = describe_estimator(final, history), floor = Json::array();
        for (std::size_t i = 0; i < history.tau.size(); ++i)
            floor.push_back(finite_or_null(rounding_floor(history.lambda[i][0], history.tau[i] - start)));
        raw["history"]["rounding_floor"] = std::move(floor);
        raw["rounding_floor"] = finite_or_null(rounding_floor(final[0], T));
        j["raw_product"] = std::move(raw);
        if (product.impacts() > 1 && std::isnan(final[0]))
            warnings.push_back("raw_product overflows in this window: the unscaled product leaves the range of double near T = 709/lambda1");
    }
    if (product.impacts() < 2) warnings.push_back("there are fewer than two impacts in the window, so there are no exponents");
    if (product.rank() == 2)
        warnings.push_back("a stick falls in the window: only deviations of the centre of mass survive it, lambda3 and lambda4 are minus infinity");
    if (product.rank() == 3) warnings.push_back("R = 0 removes every deviation of x - y at its impacts: lambda4 is minus infinity");
    return j;
}

Json describe_status(const Outcome& outcome, const SimulateRequest& r) {
    switch (outcome.reason) {
        case End::tau_end:
            return {{"reason", "tau_end"}, {"tau", outcome.tau}, {"message", "the run is complete"}};
        case End::max_impacts:
            return {{"reason", "max_impacts"}, {"tau", outcome.tau},
                    {"message", "ended after max_impacts = " + std::to_string(r.max_impacts) + " impacts (or as many sticks and touches), before tau_end"}};
        case End::stopped:
            return {{"reason", "deadline"}, {"tau", outcome.tau}, {"message", "ended by the server's time limit for one request, before tau_end"}};
    }
    return nullptr;
}

}  // namespace

SimulateRequest read_simulate_request(const Json& given) {
    std::vector<FieldError> errors = check(simulate_fields(), given);
    check_alternatives(given, errors);
    if (!errors.empty()) refuse(std::move(errors));
    const Json object = over_preset(given);
    const Values v(object);

    SimulateRequest r;
    Parameters& p = r.parameters;
    if (!present(object, si_names).empty()) {
        SiParameters si{v.number("m1"), v.number("c1"), v.number("k1"), v.number("m2"), 0, 0};
        si.F = v.number("F", 0.02 * si.epsilon());
        si.f = v.number("f", si.omega0() / (2 * std::numbers::pi));
        p.epsilon = si.epsilon();
        p.lambda = si.lambda();
        p.G = si.G();
        p.Omega = v.has("f") ? si.Omega() : 1;
        r.si = si;
    } else {
        p.epsilon = v.number("epsilon");
        p.lambda = v.number("lambda");
        p.G = v.number("G");
        p.Omega = v.number("Omega");
    }
    p.b = v.number("b");
    p.R_plus = v.number("R_plus", v.number("R"));
    p.R_minus = v.number("R_minus", v.number("R"));
    p.damping = v.word("damping") == "closed_form" ? Damping::closed_form : Damping::equation_of_motion;
    const State start = default_state(p);
    r.start = {v.number("x_dot0"), v.number("x0"), v.number("y_dot0"), v.number("y0", start.y)};

    errors = field_errors(validate(p, r.start), r.si, object);
    r.tau_end = v.has("cycles") ? v.number("cycles") * 2 * std::numbers::pi / p.Omega : v.number("tau_end");
    if (r.tau_end > longest_run) {
        const double most = longest_run * p.Omega / (2 * std::numbers::pi);
        errors.push_back({"/cycles", object["cycles"], Json::array({1e-6, most}), "cycles of 2 pi/Omega must not make a run longer than tau = 1e7: at most " + Json(most).dump()});
    }
    r.window_start = v.has("window") ? object["window"][0].get<double>() : 0;
    r.window_end = v.has("window") ? object["window"][1].get<double>() : r.tau_end;
    if (r.window_start >= r.tau_end)
        errors.push_back({"/window/0", r.window_start, Json::array({0, r.tau_end}), "the window begins after the run's end, tau_end = " + Json(r.tau_end).dump()});
    if (!errors.empty()) refuse(std::move(errors));

    r.samples_per_cycle = v.number("samples_per_cycle");
    r.max_points = static_cast<std::size_t>(v.number("max_points"));
    r.max_impacts = static_cast<long>(v.number("max_impacts"));
    r.series = v.holds("include", "series");
    r.impacts = v.holds("include", "impacts");
    r.exponents = v.holds("include", "exponents");
    r.estimators = {v.holds("exponents", "qr"), v.holds("exponents", "eigenvalues"), v.holds("exponents", "raw_product"), r.max_points};
    return r;
}

Json simulate_answer(const SimulateRequest& r, const std::function<bool()>& stop) {
    const double asked_step = 2 * std::numbers::pi / r.parameters.Omega / r.samples_per_cycle;
    const double step = std::max(asked_step, r.tau_end / static_cast<double>(r.max_points - 1));
    SeriesRecord series(step);
    ImpactRecord impacts;
    StickRecord sticks;
    TouchRecord touches;
    Lyapunov lyapunov(r.parameters, r.window_start, r.window_end, r.estimators);
    std::vector<Observer*> observers = {&sticks, &touches};
    if (r.series) observers.push_back(&series);
    if (r.impacts) observers.push_back(&impacts);
    if (r.exponents) observers.push_back(&lyapunov);

    const Outcome outcome = simulate(r.parameters, r.start, {r.tau_end, r.max_impacts, stop}, observers);

    std::vector<std::string> warnings;
    Json answer = {{"version", version()}, {"parameters", describe_parameters(r)}, {"status", describe_status(outcome, r)}, {"warnings", nullptr}};
    if (outcome.reason != End::tau_end) warnings.push_back(answer["status"]["message"]);
    if (r.series) {
        series.finish(outcome);
        if (step > asked_step)
            warnings.push_back("the series has " + Json(2 * std::numbers::pi / r.parameters.Omega / step).dump() +
                               " samples per cycle instead of " + Json(r.samples_per_cycle).dump() + ", so that it holds no more than max_points = " +
                               std::to_string(r.max_points));
        answer["series"] = {{"tau", std::move(series.tau)}, {"x", std::move(series.x)}, {"x_dot", std::move(series.x_dot)},
                            {"y", std::move(series.y)}, {"y_dot", std::move(series.y_dot)}};
    }
    if (r.impacts) answer["impacts"] = describe_impacts(impacts.impacts, r.parameters.epsilon);
    answer["sticking"] = describe_sticks(sticks.sticks);
    if (r.impacts && !touches.touches.empty()) {
        answer["touches"] = describe_touches(touches.touches);
        warnings.push_back("the mass touches a wall without an impact (tangent contact): neighbouring trajectories go different ways there");
    }
    if (r.exponents) answer["exponents"] = describe_exponents(lyapunov.product(), r, warnings);
    answer["warnings"] = warnings;
    return answer;
}

std::string version() { return VINES_VERSION; }

}  // namespace vines::api
