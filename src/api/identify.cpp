#include "api/identify.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "api/answer_size.hpp"
#include "api/describe.hpp"
#include "api/record_columns.hpp"
#include "api/si_columns.hpp"
#include "api/simulate.hpp"

namespace vines::api {

namespace {

constexpr std::size_t fewest_samples = 100;

using Columns = std::vector<CsvColumn>;

/// What would make every later step wrong without a word: line numbers count the header.
void check_record(
    const std::vector<double>& time, const MeasuredRecord& r, double omega0,
    std::vector<std::string>& notes) {
    const std::size_t n = time.size();
    if (n < fewest_samples)
        refuse(
            {{"/record", n, Json::array({fewest_samples, 1000000}),
              "the record has " + std::to_string(n) + " samples; at least " +
                  std::to_string(fewest_samples) + " are needed"}});
    for (std::size_t i = 1; i < n; ++i)
        if (!(time[i] > time[i - 1]))
            refuse(
                {{"/record/time_s/" + std::to_string(i), time[i], nullptr,
                  "line " + std::to_string(i + 2) + ", column of time: time must increase, but " +
                      Json(time[i]).dump() + " follows " + Json(time[i - 1]).dump()}});
    const std::vector<TimeGap> gaps = time_gaps(r);
    if (!gaps.empty())
        notes.push_back(
            "the record has " + std::to_string(gaps.size()) + " gap(s), the first of " +
            fmt::format("{:.4g}", (gaps[0].to - gaps[0].from) / omega0) + " s at " +
            fmt::format("{:.6g}", gaps[0].from / omega0) + " s: an impact in one is not seen");
    // A clipped signal repeats its extreme value.
    for (const auto& [name, column] :
         {std::pair("displacement", &r.x), std::pair("acceleration", &r.x_ddot)}) {
        if (column->empty()) continue;
        const auto [low, high] = std::minmax_element(column->begin(), column->end());
        for (double extreme : {*low, *high}) {
            const auto times = std::count(column->begin(), column->end(), extreme);
            if (times > 3)
                notes.push_back(
                    std::string("the ") + name + " reaches its extreme " + Json(extreme).dump() +
                    " exactly " + std::to_string(times) + " times: is it clipped?");
        }
    }
}

IdentifyRequest read_fields(const Json& given, bool with_record) {
    IdentifyRequest r;
    const Layered l = layered(identify_fields(), given);
    const Json& object = l.fields;
    r.system = read_system_alone(l, with_record);
    r.notes = r.system.notes;
    if (with_record && !r.system.si)
        refuse(
            {{"/m1", nullptr, nullptr,
              "a record in seconds needs the oscillator's own frequency: give m1, c1, k1, m2 and "
              "f, or a preset"},
             {"/k1", nullptr, nullptr,
              "a record in seconds needs the oscillator's own frequency: give m1, c1, k1, m2 and "
              "f, or a preset"}});
    r.R_given = given.contains("R") || (given.contains("R_plus") && given.contains("R_minus"));
    r.threshold = object.contains("threshold") ? object["threshold"].get<double>() : 6;
    if (object.contains("impact_times_s")) {
        for (const Json& t : object["impact_times_s"])
            r.moments.push_back(t.get<double>() * r.system.si->omega0());
        std::sort(r.moments.begin(), r.moments.end());
    }
    std::set<std::string> estimators = {"qr", "eigenvalues", "raw_product"};
    if (object.contains("exponents")) estimators = object["exponents"].get<std::set<std::string>>();
    r.estimators = {
        true, estimators.contains("eigenvalues"), estimators.contains("raw_product"),
        object.contains("max_points") ? static_cast<std::size_t>(object["max_points"].get<double>())
                                      : 20000};
    return r;
}

void read_record(IdentifyRequest& r, const Json& fields, const Columns& columns) {
    const RecordColumn time = find_column(columns, fields, time_quantity),
                       x = find_column(columns, fields, displacement_quantity),
                       a = find_column(columns, fields, acceleration_quantity);
    std::vector<std::string> names;
    for (const CsvColumn& c : columns) names.push_back(c.name);
    if (!time.column)
        refuse(
            {{"/record", names, nullptr,
              "the record has no column time_s; name it in time_column"}});
    if (!x.column && !a.column)
        refuse(
            {{"/record", names, nullptr,
              "the record has neither a displacement nor an acceleration; name them in "
              "displacement_column and acceleration_column"}});
    if (!a.column && r.moments.empty())
        refuse(
            {{"/record", nullptr, nullptr,
              "impacts are found from the spikes of the acceleration, and the record has none: "
              "give their moments in impact_times_s"}});
    const double omega0 = r.system.si->omega0();
    std::vector<double> seconds;
    for (double t : time.column->values) seconds.push_back(t * time.factor);
    for (double t : seconds) r.record.tau.push_back(t * omega0);
    if (x.column)
        for (double v : x.column->values) r.record.x.push_back(v * x.factor);
    if (a.column)
        for (double v : a.column->values)
            r.record.x_ddot.push_back(v * a.factor / (omega0 * omega0));
    check_record(seconds, r.record, omega0, r.notes);
    if (!x.column)
        r.notes.push_back(
            "without a displacement, x at the impacts rests on the acceleration alone, whose "
            "errors add up: y' and R are less certain");
    if (!a.column)
        r.notes.push_back("without an acceleration the moments of the impacts are taken as given");
    for (double tau : r.moments)
        if (!(tau > r.record.tau.front() && tau < r.record.tau.back()))
            refuse(
                {{"/impact_times_s", tau / omega0,
                  Json::array({r.record.tau.front() / omega0, r.record.tau.back() / omega0}),
                  "an impact lies outside the record"}});
}

/// Columns of impacts with their states, as /v1/simulate gives them.
void read_impacts(IdentifyRequest& r, const Json& columns) {
    const Parameters& p = r.system.parameters;
    std::vector<FieldError> errors;
    std::map<std::string, std::vector<double>> values;
    if (!columns.is_object())
        refuse(
            {{"/impacts", nullptr, nullptr,
              "impacts is an object of columns, as in the answer of /v1/simulate"}});
    const std::size_t n =
        columns.contains("side") && columns["side"].is_array() ? columns["side"].size() : 0;
    for (const char* name :
         {"tau", "side", "phase", "x", "x_dot_before", "x_dot_after", "y_dot_before",
          "y_dot_after"}) {
        const std::string where = std::string("/impacts/") + name;
        if (!columns.contains(name) || !columns[name].is_array())
            errors.push_back({where, nullptr, nullptr, std::string(name) + " is missing"});
        else if (columns[name].size() != n)
            errors.push_back(
                {where, columns[name].size(), nullptr,
                 std::string(name) + " has another length than side"});
        else
            for (std::size_t i = 0; i < n; ++i) {
                if (columns[name][i].is_number())
                    values[name].push_back(columns[name][i].get<double>());
                else
                    errors.push_back(
                        {where + "/" + std::to_string(i), columns[name][i], nullptr,
                         "must be a number"});
                if (errors.size() >= most_errors) break;
            }
    }
    if (!errors.empty()) refuse(std::move(errors));
    if (n < 2) refuse({{"/impacts", n, nullptr, "exponents need at least two impacts"}});
    for (std::size_t i = 0; i < n; ++i) {
        const auto v = [&](const char* name) { return values[name][i]; };
        if (i > 0 && !(v("tau") > values["tau"][i - 1]))
            errors.push_back(
                {"/impacts/tau/" + std::to_string(i), v("tau"), nullptr,
                 "the impacts must follow each other in time"});
        if (std::abs(v("side")) != 1)
            errors.push_back(
                {"/impacts/side/" + std::to_string(i), v("side"), Json::array({-1, 1}),
                 "a side is 1 or -1"});
        const double x_ddot =
            -v("x") - 2 * p.zeta() * v("x_dot_before") + p.epsilon * p.A() * std::sin(v("phase"));
        r.impacts.push_back(
            {.tau = v("tau"),
             .side = static_cast<int>(v("side")),
             .x = v("x"),
             .x_dot_before = v("x_dot_before"),
             .x_dot_after = v("x_dot_after"),
             .x_ddot_before = x_ddot,
             .y_dot_before = v("y_dot_before"),
             .y_dot_after = v("y_dot_after")});
        if (errors.size() >= most_errors) break;
    }
    if (!errors.empty()) refuse(std::move(errors));
    complete_impacts(p, r.impacts, 0);
}

Json describe_restitution(const Restitution& r) {
    return {
        {"R", finite_or_null(r.R)},
        {"standard_error", finite_or_null(r.error)},
        {"impacts", r.impacts}};
}

Json describe_identified(const std::vector<IdentifiedImpact>& impacts) {
    auto column = [&](auto value) {
        Json values = Json::array();
        for (const IdentifiedImpact& i : impacts) values.push_back(value(i));
        return values;
    };
    auto number = [&](double IdentifiedImpact::* member) {
        return column([member](const IdentifiedImpact& i) { return finite_or_null(i.*member); });
    };
    return {
        {"tau", number(&IdentifiedImpact::tau)},
        {"side", column([](const auto& i) { return i.side; })},
        {"x", number(&IdentifiedImpact::x)},
        {"x_dot_before", number(&IdentifiedImpact::x_dot_before)},
        {"x_dot_after", number(&IdentifiedImpact::x_dot_after)},
        {"x_ddot_before", number(&IdentifiedImpact::x_ddot_before)},
        {"y_dot_before", number(&IdentifiedImpact::y_dot_before)},
        {"y_dot_after", number(&IdentifiedImpact::y_dot_after)},
        {"R", number(&IdentifiedImpact::R)},
        {"momentum_error", number(&IdentifiedImpact::momentum_error)},
        {"status", column([](const auto& i) {
             return i.fault.empty() ? (std::isnan(i.R) ? "R is not known" : "ok") : i.fault;
         })}};
}

/// The paper's direct estimate beside ours: velocities by differences, and what follows from them.
Json describe_direct(Parameters p, const IdentifyRequest& r, const RefinedImpacts& refined) {
    if (r.record.x.empty() || r.record.x_ddot.empty()) return nullptr;
    const Identification found = identify_impacts(
        p, direct_motion(r.record, refined.tau, refined.pulse), refined.side, refined.pulse);
    if (!r.R_given) {
        if (std::isfinite(found.plus.R)) p.R_plus = std::clamp(found.plus.R, 0.0, 1.0);
        if (std::isfinite(found.minus.R)) p.R_minus = std::clamp(found.minus.R, 0.0, 1.0);
    }
    const MeasuredExponents exponents(
        p, found.impacts, continuity_of(p, found.impacts, time_gaps(r.record)).stretches,
        {true, false, false, 256});
    Json columns = describe_identified(found.impacts), lambda = Json::array();
    for (const char* same : {"time_s", "tau", "side"}) columns.erase(same);
    for (double v : exponents.all().qr()) lambda.push_back(finite_or_null(v));
    return {
        {"impacts", std::move(columns)},
        {"restitution",
         {{"plus", describe_restitution(found.plus)},
          {"minus", describe_restitution(found.minus)}}},
        {"lambda", std::move(lambda)}};
}

/// The run of the identified system from the state after the first impact whose state is known,
/// over the record's time.
Json forward_run(
    const Parameters& p, const Identification& found, const FittedMotion& motion, double tau_end) {
    for (const IdentifiedImpact& i : found.impacts) {
        if (!i.fault.empty() || std::isnan(i.y_dot_after)) continue;
        // simulate() measures the phase of the forcing from that of eq. (3); the record has its
        // own.
        const double phase = std::atan2(motion.force_cos, motion.force_sin),
                     start = std::fmod(i.tau + (phase - p.phi()) / p.Omega, p.cycle());
        const State state{i.x_dot_after, i.x, i.y_dot_after, i.x - i.side * p.b};
        ImpactRecord impacts;
        Lyapunov lyapunov(p, 0, std::numeric_limits<double>::infinity(), {true, false, false, 256});
        Observer* const observers[] = {&impacts, &lyapunov};
        simulate(p, state, {start + tau_end - i.tau, 100000, {}, start}, observers);
        Json tau = Json::array(), side = Json::array(), x = Json::array(),
             x_dot_after = Json::array();
        for (const Impact& impact : impacts.impacts) {
            tau.push_back(impact.tau - start + i.tau);
            side.push_back(impact.side);
            x.push_back(impact.x);
            x_dot_after.push_back(impact.x_dot_after);
        }
        const Exponents lambda = lyapunov.product().qr();
        Json exponents = Json::array();
        for (double v : lambda) exponents.push_back(finite_or_null(v));
        return {
            {"start", i.tau},
            {"impacts",
             {{"tau", std::move(tau)},
              {"side", std::move(side)},
              {"x", std::move(x)},
              {"x_dot_after", std::move(x_dot_after)}}},
            {"lambda", std::move(exponents)}};
    }
    return nullptr;
}

const char* reason_of(const IdentifiedExponents& e) {
    switch (e.verdict) {
        case Verdict::chaotic:
            return "the slope's 90 % interval lies above the oscillator's own damping zeta";
        case Verdict::regular:
            return "the slope's 90 % interval lies below the oscillator's own damping zeta";
        case Verdict::not_decided:
            return "the record is too short to say: the slope's 90 % interval holds the "
                   "oscillator's own damping zeta, or there are too few impacts (20 for chaotic; "
                   "for regular 200, or 80 whose jumps are alike: a chaotic motion may be in step "
                   "for a while)";
        case Verdict::none: return "the motion dies out: it has no exponents of a long run";
    }
    return "";
}

/// How fast to sample, where impacts were not seen because their pulse fell between two samples;
/// else empty.
std::string sampling_advice(const RefinedImpacts& refined, double step, double omega0) {
    // A pulse of a sample or more is seen. What is fitted of a shorter one is little more than that
    // it is short.
    if (refined.tau.empty() || refined.pulse >= step) return "";
    constexpr double most = 4;
    const double rate = omega0 / step * std::min(most, 2 * step / refined.pulse);
    return "the impacts' pulses last about " +
           fmt::format("{:.3g}", 1000 * refined.pulse / omega0) + " ms, the samples are " +
           fmt::format("{:.3g}", 1000 * step / omega0) +
           " ms apart: pulses may fall between samples; sample at " +
           fmt::format("{:.4g}", std::ceil(rate)) + " Hz or more";
}

/// The exponents as of a simulation, in the record's time.
Json describe_measured(
    const MeasuredExponents& e, const ExponentOptions& estimators, const Continuity& c,
    const std::vector<IdentifiedImpact>& impacts, Warnings& warnings) {
    const ExponentOptions of_all = {
        .qr = true, .eigenvalues = false, .raw_product = false, .history = estimators.history};
    const ExponentOptions of_longest = {
        .qr = false,
        .eigenvalues = estimators.eigenvalues,
        .raw_product = estimators.raw_product,
        .history = estimators.history};
    Json j = describe_window(e.all());
    add_estimators(j, e.all(), growth_of(e.all()), of_all, true);
    for (Json& tau : j["qr"]["history"]["tau"]) tau = e.moment(tau);
    std::vector<Warning> odd;
    add_warnings(e.all(), of_all, true, odd);
    add_warnings(e.longest(), of_longest, true, odd);
    for (const Warning& w : odd) {
        const std::string text = text_of(w, any_size);
        if (std::find(warnings.begin(), warnings.end(), text) == warnings.end())
            warnings.push_back(text);
    }
    Json longest = describe_window(e.longest());
    add_estimators(longest, e.longest(), growth_of(e.longest()), of_longest, true);
    for (const char* name : {"eigenvalues", "raw_product"})
        if (longest.contains(name)) {
            j[name] = longest[name];
            j[name]["window"] = longest["window"];
        }
    if (c.stretches.empty()) return j;
    j["window"] = {impacts[c.stretches.front().first].tau, impacts[c.stretches.back().last].tau};
    Json from = Json::array(), to = Json::array();
    for (const KnownStretch& s : c.stretches)
        from.push_back(impacts[s.first].tau), to.push_back(impacts[s.last].tau);
    j["stretches"] = {{"tau_start", std::move(from)}, {"tau_end", std::move(to)}};
    j["duration"] = e.all().end_tau() - e.all().start_tau();
    return j;
}

}  // namespace

IdentifyRequest read_identify_request(const Json& object) {
    Json fields = object;
    const bool has_record = object.contains("record"), has_impacts = object.contains("impacts");
    fields.erase("record");
    fields.erase("impacts");
    if (has_record == has_impacts)
        refuse(
            {{"/record", nullptr, nullptr,
              "give either record: {time_s, displacement_m, acceleration_m_s2} or impacts, with "
              "their states"}});
    IdentifyRequest r = read_fields(fields, has_record);
    if (has_impacts) {
        read_impacts(r, object["impacts"]);
        return r;
    }
    const Json& record = object["record"];
    Columns columns;
    if (!record.is_object())
        refuse({{"/record", nullptr, nullptr, "record is an object of columns"}});
    for (const auto& [name, values] : record.items()) {
        CsvColumn column{name, {}};
        if (!values.is_array())
            refuse({{"/record/" + name, nullptr, nullptr, "a column is an array of numbers"}});
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!values[i].is_number())
                refuse(
                    {{"/record/" + name + "/" + std::to_string(i), values[i], nullptr,
                      "must be a number"}});
            column.values.push_back(values[i].get<double>());
        }
        if (!columns.empty() && column.values.size() != columns[0].values.size())
            refuse(
                {{"/record/" + name, column.values.size(), nullptr,
                  "has another length than " + columns[0].name + " (" +
                      std::to_string(columns[0].values.size()) + ")"}});
        columns.push_back(std::move(column));
    }
    read_record(r, fields, columns);
    return r;
}

IdentifyRequest read_identify_request(const Json& fields, std::string_view csv) {
    IdentifyRequest r = read_fields(fields, true);
    read_record(r, fields, parse_csv(csv));
    return r;
}

Json identify_answer(const IdentifyRequest& r) {
    Parameters p = r.system.parameters;
    const double omega0 = r.system.si ? r.system.si->omega0() : 0;
    Warnings warnings = r.notes;
    Identification found;
    RefinedImpacts refined;
    Json signal;
    std::vector<std::string> doubts;
    if (r.impacts.empty()) {
        const double step = (r.record.tau.back() - r.record.tau.front()) /
                            static_cast<double>(r.record.tau.size() - 1);
        Spikes spikes{{}, std::nan("")};
        if (!r.record.x_ddot.empty()) spikes = find_spikes(r.record, r.threshold);
        if (!r.moments.empty()) {
            std::vector<Spike> given;
            for (double tau : r.moments) {
                const auto near = std::min_element(
                    spikes.spikes.begin(), spikes.spikes.end(),
                    [&](const Spike& a, const Spike& b) {
                        return std::abs(a.tau - tau) < std::abs(b.tau - tau);
                    });
                Spike s{tau, 0, 0, 0};
                if (near != spikes.spikes.end() && std::abs(near->tau - tau) < 3 * step) s = *near;
                s.tau = tau;
                given.push_back(s);
            }
            spikes.spikes = std::move(given);
        }
        if (spikes.spikes.size() < 2)
            throw Problem(
                422,
                "nothing in the acceleration looks like impacts: " +
                    std::to_string(spikes.spikes.size()) + " spike(s) rise above threshold = " +
                    fmt::format("{:.3g}", r.threshold) + " standard deviations of the noise (" +
                    fmt::format("{:.3g}", spikes.noise * omega0 * omega0) + " m/s^2)",
                {{"/threshold", r.threshold, Json::array({3, 1000}),
                  "lower it, or give impact_times_s"}});
        refined = refine_impacts(p, r.record, spikes.spikes, r.moments.empty() ? r.threshold : 0);
        found = identify_impacts(p, refined.motion, refined.side, refined.pulse);
        if (!refined.dropped.empty())
            warnings.push_back(
                std::to_string(refined.dropped.size()) +
                " spike(s) without a jump of the velocity were dropped, the first at " +
                fmt::format("{:.6g}", refined.dropped[0].tau / omega0) + " s");
        signal = {
            {"samples", r.record.tau.size()},
            {"sampling_rate", omega0 / step},
            {"noise_displacement", finite_or_null(refined.motion.noise_x)},
            {"noise_acceleration", finite_or_null(refined.motion.noise_x_ddot * omega0 * omega0)},
            {"misfit",
             {{"displacement", finite_or_null(refined.motion.misfit_x)},
              {"acceleration", finite_or_null(refined.motion.misfit_x_ddot)}}},
            {"pulse_s", refined.pulse / omega0},
            {"G", std::hypot(refined.motion.force_sin, refined.motion.force_cos) / p.epsilon /
                      std::hypot(1.0, p.lambda * p.epsilon * p.Omega)},
            {"force_sin", refined.motion.force_sin},
            {"force_cos", refined.motion.force_cos}};
        p.G = signal["G"];
        if (!b_agrees(p, found))
            warnings.push_back(
                "the impacts' momentum fits b = " + fmt::format("{:.4g}", found.b_fitted) +
                " m, not b = " + fmt::format("{:.4g}", p.b) + " m (" + r.system.origin.at("b") +
                ")");
        if (!std::isfinite(found.b_fitted))
            warnings.push_back("no b is fitted to the impacts' momentum: " + found.b_fault);
        doubts = doubts_of(p, refined, found);
        // What is fitted of the pulses is advice only where the rest of the fit is right.
        if (const std::string advice = sampling_advice(refined, step, omega0);
            doubts.empty() && !r.record.x_ddot.empty() && !advice.empty())
            warnings.push_back(advice);
    } else {
        found.impacts = r.impacts;
        found.b_fitted = found.b_error = std::nan("");
        found.plus = restitution_of(r.impacts, 1);
        found.minus = restitution_of(r.impacts, -1);
    }
    if (!r.R_given) {
        if (std::isfinite(found.plus.R)) p.R_plus = std::clamp(found.plus.R, 0.0, 1.0);
        if (std::isfinite(found.minus.R)) p.R_minus = std::clamp(found.minus.R, 0.0, 1.0);
    }
    const Continuity continuity = continuity_of(p, found.impacts, time_gaps(r.record));
    if (continuity.left_out > 0)
        warnings.push_back(
            std::to_string(continuity.left_out) + " of " + std::to_string(found.impacts.size()) +
            " impacts are inconsistent and left out; impacts.status says why");
    if (continuity.missing > 0)
        warnings.push_back(
            "between " + std::to_string(continuity.missing) +
            " pair(s) of impacts the mass did not fly freely: an impact is missing, both stuck "
            "together, or the record has a gap");
    if (continuity.stretches.size() > 1)
        warnings.push_back(
            "the impacts fall into " + std::to_string(continuity.stretches.size()) +
            " stretches: qr adds up what it knows of each, eigenvalues and raw_product are of the "
            "longest");
    if (continuity.share > Continuity::most)
        doubts.insert(
            doubts.begin(), fmt::format("{:.3g}", 100 * continuity.share) +
                                " % of the impacts are left out or missing, more than " +
                                fmt::format("{:.3g}", 100 * Continuity::most) + " %");

    const MeasuredExponents exponents(p, found.impacts, continuity.stretches, r.estimators);
    IdentifiedExponents judged = judge_exponents(
        p, exponents.all().qr_history(), exponents.all().start_tau(),
        is_representative(found.impacts));
    if (!doubts.empty()) judged.verdict = Verdict::not_decided;
    else if (p.G == 0 || dies_out(found.impacts)) judged.verdict = Verdict::none;
    for (const std::string& doubt : doubts) warnings.push_back("no verdict: " + doubt);
    System used = r.system;
    used.parameters = p;
    if (!r.R_given) used.origin["R_plus"] = used.origin["R_minus"] = "estimated from the impacts";
    if (r.impacts.empty()) {
        used.si->F = p.G * p.epsilon;
        used.origin["F"] = used.origin["G"] = "fitted to the record";
    }
    Json answer = {{"version", version()}, {"parameters", describe_system(used)}};
    answer["parameters"]["derived"] = describe_derived(used);
    if (!signal.is_null()) answer["signal"] = std::move(signal);
    answer["impacts"] = describe_identified(found.impacts);
    answer["restitution"] = {
        {"plus", describe_restitution(found.plus)}, {"minus", describe_restitution(found.minus)}};
    answer["b_fitted"] = {
        {"b", finite_or_null(found.b_fitted)}, {"standard_error", finite_or_null(found.b_error)}};
    answer["exponents"] =
        describe_measured(exponents, r.estimators, continuity, found.impacts, warnings);
    answer["slope"] = {
        {"lambda1", finite_or_null(judged.slope)},
        {"low", finite_or_null(judged.low)},
        {"high", finite_or_null(judged.high)}};
    answer["verdict"] = word(judged.verdict);
    answer["verdict_reason"] = doubts.empty() ? reason_of(judged) : doubts[0];
    if (r.impacts.empty()) {
        answer["direct"] = describe_direct(r.system.parameters, r, refined);
        answer["forward"] = forward_run(p, found, refined.motion, r.record.tau.back());
    }
    if (r.system.si)
        for (const char* part : {"impacts", "exponents", "direct", "forward"})
            if (answer.contains(part)) add_si(answer[part], *r.system.si);
    answer["warnings"] = warnings;
    return answer;
}

}  // namespace vines::api
