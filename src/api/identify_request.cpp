#include <fmt/format.h>

#include <algorithm>

#include "api/identify_parts.hpp"
#include "api/parse.hpp"
#include "api/simulate.hpp"
#include "core/measurement/measured_load.hpp"
#include "core/measurement/measured_record.hpp"
#include "core/motion/elementary.hpp"

namespace vines::api {

namespace {

constexpr std::size_t fewest_samples = 100;

// Longest record with gaps: this long in tau, or this many times the time that has samples.
constexpr double longest_sparse = 1e5, most_spans = 4;

// Work on a sample in the search for hum, in steps of reading.
constexpr std::size_t hum_steps = 4;

/// Checks the times, in seconds. `lines`: line numbers of the samples in a CSV text.
void check_times(const std::vector<double>& time, const std::vector<std::uint32_t>& lines) {
    const std::size_t n = time.size();
    if (n < fewest_samples)
        refuse(
            {{"/record", n, Json::array({fewest_samples, nullptr}),
              "the record has " + std::to_string(n) + " samples; at least " +
                  std::to_string(fewest_samples) + " are needed"}});
    for (std::size_t i = 1; i < n; ++i)
        if (!(time[i] > time[i - 1]))
            refuse(
                {{"/record/time_s/" + std::to_string(i), time[i], nullptr,
                  (lines.empty() ? "sample " + std::to_string(i)
                                 : "line " + std::to_string(lines[i])) +
                      ", column of time: time must increase, but " + Json(time[i]).dump() +
                      " follows " + Json(time[i - 1]).dump()}});
}

/// Refuses a record that consists of gaps: an identification takes time and memory in proportion to
/// the span.
void check_span(const std::vector<double>& tau, double omega0) {
    const double span = tau.back() - tau.front(), sampled = count_of(tau) * median(steps_of(tau)),
                 longest = std::max(longest_sparse, most_spans * sampled);
    if (span <= longest) return;
    refuse(
        {{"/record/time_s", span / omega0, Json::array({0, longest / omega0}),
          fmt::format(
              "the record spans {:.6g} s, of which {:.6g} s have samples; it can span {:.6g} s: "
              "identify its parts by themselves",
              span / omega0, sampled / omega0, longest / omega0)}});
}

/// Warns of gaps and clipping.
void note_flaws(const MeasuredRecord& r, double omega0, Warnings& notes) {
    const std::vector<Interval> gaps = time_gaps(r);
    if (!gaps.empty())
        notes.push_back(fmt::format(
            "the record has {} gap(s), the first of {:.4g} s at {:.6g} s: impacts inside a gap "
            "cannot be detected",
            gaps.size(), (gaps[0].to - gaps[0].from) / omega0, gaps[0].from / omega0));
    // A clipped signal repeats its extreme value.
    const auto warn_of_clipping = [&notes](
                                      const char* name, const std::vector<double>& column,
                                      double unit, const char* unit_name) {
        if (column.empty()) return;
        const auto [low, high] = std::minmax_element(column.begin(), column.end());
        for (const double extreme : {*low, *high})
            if (const auto times = std::count(column.begin(), column.end(), extreme); times > 3)
                notes.push_back(fmt::format(
                    "the {} reaches its extreme {:.6g} {} exactly {} times: is it clipped?", name,
                    extreme * unit, unit_name, times));
    };
    warn_of_clipping("displacement", r.x, 1, "m");
    warn_of_clipping("acceleration", r.x_ddot, omega0 * omega0, "m/s^2");
}

/// Request from the JSON fields, without its record or impacts. `with_record`: a record follows, in
/// seconds, which requires a system in SI; `forcing_fitted`: the forcing need not be given.
IdentifyRequest read_fields(const Json& given, bool with_record, bool forcing_fitted) {
    IdentifyRequest r;
    const MergedFields merged = merge_with_preset(identify_fields(), given);
    r.system = read_system_alone(merged, forcing_fitted);
    r.forcing_fitted = forcing_fitted;
    if (with_record && !r.system.si) {
        const std::string detail =
            "a record in seconds needs the natural frequency: give m1, c1, k1, m2, f, or a preset";
        refuse({{"/m1", nullptr, nullptr, detail}, {"/k1", nullptr, nullptr, detail}});
    }
    Measurement& m = r.measurement;
    m.parameters = r.system.parameters;
    m.R_given = given.contains("R") || (given.contains("R_plus") && given.contains("R_minus"));
    m.threshold = merged["threshold"];
    if (merged.has("impact_times_s")) {
        if (!with_record)
            refuse(
                "/impact_times_s",
                "impact_times_s needs a record; a list of impacts has its own times");
        for (const Json& t : merged.fields["impact_times_s"])
            m.impact_times.push_back(t.get<double>() * r.system.si->omega0());
        std::sort(m.impact_times.begin(), m.impact_times.end());
    }
    m.fixed = fixed_of(merged["fixed"]);
    const std::set<std::string> fit = merged["fit"];
    m.laws = {.friction = fit.contains("mu"), .R_slope = fit.contains("R_of_speed")};
    if (m.laws.R_slope && !m.parameters.has_constant_R())
        refuse(
            {{"/fit", "R_of_speed", nullptr,
              "restitution gives R of the speed: give R instead, or do not fit R_of_speed"}});
    m.uncertainty = {
        merged["m1_uncertainty"], merged["c1_uncertainty"], merged["k1_uncertainty"],
        merged["m2_uncertainty"]};
    if (with_record)
        for (const double hertz : {50, 60})
            m.mains.push_back(2 * std::numbers::pi * hertz / r.system.si->omega0());
    m.estimators = read_estimators(merged);
    m.estimators.qr = true;  // the verdict needs it
    r.include = merged["include"].get<std::set<std::string>>();
    if (!with_record && m.laws.any())
        refuse({{"/fit", fit, nullptr, "laws are fitted to a record, not to a list of impacts"}});
    if (!with_record && !r.include.empty())
        refuse(
            {{"/include", r.include, nullptr,
              "motion and direct_exponents need a record instead of a list of impacts"}});
    if (r.include.contains("direct_exponents")) m.direct_estimators = m.estimators;
    r.most_points = merged["max_points"];
    return r;
}

/// Sets F and phase if they are fixed. F: from the request, else from a measured channel of the
/// forcing, else from the preset. Phase: from the request, else from a channel. phi() converts a
/// given phase of the base motion to the phase of the force; a channel already gives the latter.
void read_known_forcing(IdentifyRequest& r, const Json& given) {
    const MergedFields merged = merge_with_preset(identify_fields(), given);
    const std::set<std::string> fixed = merged["fixed"];
    const auto refuse_unknown = [](const char* name) {
        refuse(
            {{"/fixed", name, nullptr,
              std::string(name) +
                  " is fixed, but neither given nor measured by a channel of the record"}});
    };
    const Parameters& p = r.system.parameters;
    std::optional<ChannelForcing> channel;
    if (r.forcing) channel = channel_forcing(*r.forcing, r.system);
    if (fixed.contains(fixed_amplitude)) {
        const bool is_given = given.contains("F") || given.contains("G");
        if (channel && !is_given) r.measurement.forcing.amplitude = channel->amplitude;
        else if (is_given || merged.has("F") || merged.has("G"))
            r.measurement.forcing.amplitude = forcing_of(p);
        else refuse_unknown(fixed_amplitude);
    }
    if (fixed.contains(fixed_phase)) {
        if (merged.has(fixed_phase))
            r.measurement.forcing.phase = merged[fixed_phase].get<double>() + p.phi();
        else if (channel) r.measurement.forcing.phase = channel->phase;
        else refuse_unknown(fixed_phase);
    }
}

template <class Change>
void change_each(std::vector<double>& values, CancelCheck& cancel, const Change& change) {
    for (double& v : values) {
        cancel.step();
        v = change(v);
    }
}

/// Removes hum of the mains, with a note of each line, and takes its frequency.
void take_hum(IdentifyRequest& r, double omega0, CancelCheck& cancel) {
    std::vector<double>& mains = r.measurement.mains;
    for (const Hum& hum : remove_hum(
             r.measurement.record, mains, r.measurement.parameters.Omega,
             [&cancel] { cancel.step(hum_steps); })) {
        r.system.notes.push_back(fmt::format(
            "a hum of {:.3g} {} at {:.4g} Hz was removed from the {}",
            hum.amplitude * (hum.in_displacement ? 1e6 : omega0 * omega0),
            hum.in_displacement ? "um" : "m/s^2", hum.Omega * omega0 / (2 * std::numbers::pi),
            hum.in_displacement ? "displacement" : "acceleration"));
        for (double& Omega : mains)
            if (std::abs(hum.Omega / Omega - 1) < 0.01) Omega = hum.Omega;
    }
}

void read_record(IdentifyRequest& r, const Json& fields, Csv csv, CancelCheck& cancel) {
    std::vector<CsvColumn>& columns = csv.columns;
    const RecordColumn time = find_column(columns, fields, time_channel),
                       x = find_column(columns, fields, displacement_channel),
                       a = find_column(columns, fields, acceleration_channel);
    if (!time.column && !csv.lines.empty() && columns[0].name == "1") refuse_unnamed(csv);
    for (const RecordColumn* c : {&time, &x, &a})
        if (c->column) refuse_missing_numbers(*c->column, csv.lines);
    if (!time.column)
        refuse(
            {{"/record", names_of(columns), nullptr,
              "the record has no column time_s; name its column of times in time_column"}});
    if (!x.column && !a.column)
        refuse(
            {{"/record", names_of(columns), nullptr,
              "the record has neither a displacement nor an acceleration; name them in "
              "displacement_column and acceleration_column"}});
    const double omega0 = r.system.si->omega0();
    MeasuredRecord& record = r.measurement.record;
    // A column can serve as two channels; one that serves as no other is not copied.
    const auto take = [&columns](const RecordColumn& from, bool again) {
        std::vector<double>& values =
            columns[static_cast<std::size_t>(from.column - columns.data())].values;
        return again ? values : std::move(values);
    };
    if (a.column) record.x_ddot = take(a, a.column == x.column || a.column == time.column);
    if (x.column) record.x = take(x, x.column == time.column);
    record.tau = take(time, false);
    change_each(record.tau, cancel, [&](double t) { return t * time.factor; });
    check_times(record.tau, csv.lines);
    change_each(record.tau, cancel, [&](double t) { return t * omega0; });
    check_span(record.tau, omega0);
    change_each(record.x, cancel, [&](double v) { return v * x.factor; });
    change_each(record.x_ddot, cancel, [&](double v) { return v * a.factor / (omega0 * omega0); });
    note_flaws(record, omega0, r.system.notes);
    take_hum(r, omega0, cancel);
    cancel.step(record.tau.size());
    if (!x.column)
        r.system.notes.push_back(
            "without a displacement, x at the impacts rests on the acceleration alone, whose "
            "errors add up: y' and R are less certain");
    if (!a.column && r.measurement.impact_times.empty())
        r.system.notes.push_back(
            "without an acceleration only impacts that cause a visible kink in the displacement "
            "are found");
    for (double tau : r.measurement.impact_times)
        if (!(tau > record.tau.front() && tau < record.tau.back()))
            refuse(
                {{"/impact_times_s", tau / omega0,
                  Json::array({record.tau.front() / omega0, record.tau.back() / omega0}),
                  "an impact lies outside the record"}});
}

/// Columns of equal length from a record in JSON. Each column's JSON is freed after it is read.
std::vector<CsvColumn> read_record_columns(Json record, CancelCheck& cancel) {
    std::vector<CsvColumn> columns;
    if (!record.is_object())
        refuse("/record", "record must be an object that maps column names to arrays of numbers");
    for (auto& [name, values] : record.get_ref<Json::object_t&>()) {
        CsvColumn column{name, {}, {}};
        if (!values.is_array()) refuse("/record/" + name, "a column is an array of numbers");
        column.values.reserve(entries_of(values));
        take_entries(values, [&](std::size_t i, double number, const Json& value) {
            cancel.step();
            if (std::isnan(number))
                refuse(
                    {{"/record/" + column.name + "/" + std::to_string(i), beginning_of(value),
                      nullptr, "must be a number"}});
            column.values.push_back(number);
        });
        if (!columns.empty() && column.values.size() != columns[0].values.size())
            refuse(
                {{"/record/" + name, column.values.size(), nullptr,
                  "differs in length from " + shortened(columns[0].name) + " (" +
                      std::to_string(columns[0].values.size()) + ")"}});
        values = nullptr;
        columns.push_back(std::move(column));
    }
    return columns;
}

/// Samples of the forcing's channel, with empty cells left out.
struct ForcingSamples {
    LoadKind kind;
    std::string name;
    std::vector<double> seconds, values;  ///< values in m/s^2, m or N
};

/// nullopt without a channel.
std::optional<ForcingSamples> forcing_samples(
    const std::vector<CsvColumn>& columns, const Json& fields) {
    const RecordColumn time = find_column(columns, fields, time_channel);
    RecordColumn channel{};
    ForcingSamples samples{};
    for (const auto& [kind, each] :
         {std::pair{LoadKind::base_acceleration, &base_acceleration_channel},
          std::pair{LoadKind::base_displacement, &base_displacement_channel},
          std::pair{LoadKind::force, &force_channel}}) {
        const RecordColumn found = find_column(columns, fields, *each);
        if (!found.column) continue;
        if (channel.column)
            refuse(
                "/record/" + shortened(found.column->name),
                "the record has two channels of the forcing, " + shortened(channel.column->name) +
                    " and this one: the model has one forcing");
        channel = found;
        samples.kind = kind;
        samples.name = found.column->name;
    }
    if (!time.column || !channel.column) return std::nullopt;
    // A slower channel has empty cells.
    for (std::size_t k = 0; k < time.column->values.size(); ++k) {
        if (std::isnan(channel.column->values[k] + time.column->values[k])) continue;
        samples.seconds.push_back(time.column->values[k] * time.factor);
        samples.values.push_back(channel.column->values[k] * channel.factor);
    }
    return samples;
}

/// Fits a harmonic to the channel. Problem 422 if one harmonic does not describe it.
MeasuredForcing measured_forcing(const ForcingSamples& s, CancelCheck& cancel) {
    const std::optional<Harmonic> h =
        s.seconds.empty()
            ? std::nullopt
            : harmonic_of(s.seconds, s.values, [&] { cancel.step(s.seconds.size()); });
    if (!h)
        refuse(
            "/record/" + shortened(s.name),
            "column " + shortened(s.name) +
                " is not harmonic: one sine must explain three quarters of it, over five cycles "
                "or more");
    return {s.kind, h->omega / (2 * std::numbers::pi), h->sin, h->cos};
}

/// Takes what the channel shows beyond a sine as the load of the record; then the harmonic is its
/// fundamental. Expects that the record has been read.
void take_load(IdentifyRequest& r, ForcingSamples s, CancelCheck& cancel) {
    const double omega0 = r.system.si->omega0();
    // In the units of the model, m (per unit of tau squared).
    const double unit = s.kind == LoadKind::force               ? r.system.si->k1
                        : s.kind == LoadKind::base_acceleration ? omega0 * omega0
                                                                : 1;
    MeasuredForcing& m = *r.forcing;
    for (double& t : s.seconds) t *= omega0;
    for (double& v : s.values) v /= unit;
    const MeasuredRecord& record = r.measurement.record;
    const Parameters& p = r.system.parameters;
    const std::size_t samples = s.seconds.size();
    r.measurement.forcing.load = MeasuredLoad::of(
        {s.kind, std::move(s.seconds), std::move(s.values), record.tau.front(), record.tau.back(),
         p.lambda * p.epsilon},
        {2 * std::numbers::pi * m.f / omega0, m.sin / unit, m.cos / unit},
        [&] { cancel.step(samples); });
    if (!r.measurement.forcing.load) return;
    // A modulated sine has a smaller mean than its fundamental.
    const double ratio = elementary::modulus(r.measurement.forcing.load->fundamental) /
                         channel_forcing(m, r.system).amplitude;
    m.sin *= ratio, m.cos *= ratio;
}

/// Request with a record: reads the forcing, the fields and the columns in this order, because a
/// measured channel of the forcing supplies f unless the request gives it; then its load.
IdentifyRequest read_request_of_record(const Json& given, Csv csv, CancelCheck& cancel) {
    // Checks all fields first: the lookup of columns below reads them unchecked.
    refuse_any(check(identify_fields(), given));
    std::optional<ForcingSamples> samples = forcing_samples(csv.columns, given);
    std::optional<MeasuredForcing> forcing;
    if (samples) forcing = measured_forcing(*samples, cancel);
    Json fields = given;
    const bool f_is_given = fields.contains("f") || fields.contains("Omega");
    if (forcing && !f_is_given) fields["f"] = forcing->f;
    IdentifyRequest r = read_fields(fields, true, true);
    r.forcing = forcing;
    if (forcing && !f_is_given)
        r.system.origin["f"] = r.system.origin["Omega"] = "measured with the record";
    read_record(r, fields, std::move(csv), cancel);
    if (samples) take_load(r, std::move(*samples), cancel);
    read_known_forcing(r, fields);
    return r;
}

}  // namespace

IdentifyRequest read_identify_request(Json fields, const ReadLimits& limits) {
    CancelCheck cancel = limits.check();
    const bool has_record = fields.contains("record"), has_impacts = fields.contains("impacts");
    Json record = std::move(fields["record"]), impacts = std::move(fields["impacts"]);
    for (const char* name : {"record", "impacts"}) fields.erase(name);
    if (has_record == has_impacts)
        refuse(
            "/record",
            "give either record: {time_s, displacement_m, acceleration_m_s2} or impacts, with "
            "their states");
    if (has_impacts) {
        IdentifyRequest r = read_fields(fields, false, !has_phase(impacts));
        read_impact_list(r, std::move(impacts), limits.most_impacts, cancel);
        return r;
    }
    return read_request_of_record(
        fields, {read_record_columns(std::move(record), cancel), {}}, cancel);
}

IdentifyRequest read_identify_request(
    const Json& fields, std::string_view csv, const ReadLimits& limits) {
    CancelCheck cancel = limits.check();
    return read_request_of_record(fields, parse_csv(csv, limits), cancel);
}

}  // namespace vines::api
