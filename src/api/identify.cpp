
#include <fmt/format.h>

#include <algorithm>

#include "api/describe.hpp"
#include "api/identify_parts.hpp"
#include "api/properties.hpp"
#include "api/version.hpp"

namespace vines::api {

namespace {

// Members of an answer: more than there are. They are copied if their object grows.
constexpr std::size_t most_parts = 20;

/// The impacts that an answer lists: without the last ones of a chatter that ends in sticking.
std::vector<IdentifiedImpact> listed(std::vector<IdentifiedImpact> impacts) {
    std::erase_if(impacts, [](const IdentifiedImpact& i) { return i.comes_to_rest; });
    return impacts;
}

Json describe_identified(const std::vector<IdentifiedImpact>& impacts) {
    // A long list is copied only if it has to be.
    if (std::ranges::any_of(impacts, &IdentifiedImpact::comes_to_rest))
        return describe_identified(listed(impacts));
    Json j = describe(identified_wall_columns, impacts),
         others = describe(identified_columns, impacts);
    make_room(j, others.size());
    for (auto& [name, value] : others.get_ref<Json::object_t&>()) j[name] = std::move(value);
    return j;
}

Json describe_walls(const Identification& found) {
    return {
        {"plus", describe(properties::restitution, found.plus)},
        {"minus", describe(properties::restitution, found.minus)}};
}

/// Properties of the record, as estimated by the fit.
Json describe_signal(const Measurement& m, const MeasurementResult& result, double omega0) {
    const FoundImpacts& refined = *result.refined;
    const JointFit& fit = refined.fit;
    const double amplitude_sin = fit.values[Unknown::force_sin],
                 amplitude_cos = fit.values[Unknown::force_cos];
    // The fit has the phase at the middle of the record; here it is at t = 0.
    const double angle = fit.values[Unknown::Omega] * fit.tau_middle, sin = elementary::sin(angle),
                 cos = elementary::cos(angle);
    return {
        {"samples", m.record.tau.size()},
        {"sampling_rate", omega0 / m.step()},
        {"noise_displacement", finite_or_null(fit.x.noise)},
        {"noise_acceleration", finite_or_null(fit.a.noise * omega0 * omega0)},
        {"misfit",
         {{"displacement", finite_or_null(fit.x.misfit)},
          {"acceleration", finite_or_null(fit.a.misfit)}}},
        {"pulse_s", refined.pulse.length() / omega0},
        {"pulse_delay_s",
         refined.pulse.empty() ? Json(nullptr) : Json(refined.pulse.delay() / omega0)},
        {"pulse_spoils_s",
         Json::array({-refined.extent.before / omega0, refined.extent.after / omega0})},
        {"pulses_unseen", refined.unseen},
        {"G", result.parameters.G},
        {"force_sin", amplitude_sin * cos + amplitude_cos * sin},
        {"force_cos", amplitude_cos * cos - amplitude_sin * sin}};
}

Json describe_forward(const std::optional<ForwardRun>& run) {
    if (!run) return nullptr;
    return {
        {"start", run->start},
        {"impacts", describe(forward_impact_columns, run->impacts)},
        {"lambda", column(run->lambda)}};
}

const char* reason_of(const IdentifiedExponents& e) {
    switch (e.verdict) {
        case Verdict::chaotic:
            return "the slope's 90 % interval lies above the oscillator's own damping zeta";
        case Verdict::regular:
            return "the slope's 90 % interval lies below the oscillator's own damping zeta";
        case Verdict::not_decided:
            if (e.weakens)
                return "the impacts weaken to less than half from the first quarter of the record "
                       "to the last although the motion is forced: a transient, or the falling "
                       "part of a modulation; a longer record can decide";
            return "the record is too short for a verdict: the slope's 90 % interval contains the "
                   "oscillator's own damping zeta, or there are too few impacts (chaotic needs 24; "
                   "regular needs 200, or 80 with similar jumps, since a chaotic motion can be "
                   "synchronised for a while)";
        case Verdict::none: return "the motion dies out and has no long-term exponents";
    }
    return "";
}

/// A recommended sampling rate if impacts were missed because their pulse fell between two samples;
/// otherwise empty.
std::string sampling_advice(const FoundImpacts& refined, double step, double omega0) {
    const auto impacts = static_cast<double>(refined.fit.impacts.size()),
               unseen = static_cast<double>(refined.unseen);
    // A few pulses are lost for other reasons.
    constexpr double few = 0.03, most = 8;
    if (!(unseen > few * impacts)) return "";
    // A pulse shorter than the step is seen with probability length/step; two samples per pulse
    // suffice.
    const double rate = omega0 / step * std::min(most, 2 * impacts / (impacts - unseen));
    return fmt::format(
        "the pulses of {} of {} impacts are not seen, although the displacement shows their kinks: "
        "if they fall between samples, {:.4g} ms apart, sample at {:.4g} Hz or more",
        refined.unseen, refined.fit.impacts.size(), 1000 * step / omega0, std::ceil(rate));
}

/// Exponents in the form of a simulation's, with times of the record.
Json describe_measured(
    const MeasuredExponents& e, const std::vector<KnownStretch>& stretches,
    const std::vector<IdentifiedImpact>& impacts, Warnings& warnings) {
    Json j = describe(properties::window, e.all());
    add_estimators(j, e.all(), growth_of(e.all()), e.all().options(), true, false);
    change_numbers(j["qr"]["history"][quantity.tau.name].get_binary(), [&e](double tau) {
        return e.moment(tau);
    });
    std::vector<Warning> odd;
    add_warnings(e.all(), true, odd);
    add_warnings(e.longest(), true, odd);
    for (const Warning& w : odd) {
        const std::string text = text_of(w, any_size);
        if (std::ranges::count(warnings, text) == 0) warnings.push_back(text);
    }
    Json longest = describe(properties::window, e.longest());
    add_estimators(
        longest, e.longest(), growth_of(e.longest()), e.longest().options(), true, false);
    for (const char* name : {"eigenvalues", "raw_product"})
        if (longest.contains(name)) {
            j[name] = longest[name];
            j[name]["window"] = longest["window"];
        }
    if (stretches.empty()) return j;
    j["window"] = {impacts[stretches.front().first].tau, impacts[stretches.back().last].tau};
    j["stretches"] = {
        {quantity.tau_start.name,
         column(stretches, [&](const auto& s) { return impacts[s.first].tau; })},
        {quantity.tau_end.name,
         column(stretches, [&](const auto& s) { return impacts[s.last].tau; })}};
    j["duration"] = e.all().end_tau() - e.all().start_tau();
    return j;
}

/// The direct estimate; warnings of its exponents if they are included.
Json describe_direct(
    const IdentifyRequest& r, const std::optional<DirectEstimate>& direct, Warnings& warnings) {
    if (!direct) return nullptr;
    const Identification& found = direct->found;
    Json j = {
        {"impacts", describe(identified_columns, listed(found.impacts))},
        {"restitution", describe_walls(found)},
        {"lambda", column(direct->lambda)}};
    if (!r.include.contains("direct_exponents")) return j;
    Warnings odd;
    j["exponents"] = describe_measured(direct->exponents, direct->stretches, found.impacts, odd);
    for (const std::string& text : odd) warnings.push_back("direct: " + text);
    return j;
}

/// The fitted motion at every n-th sample of the record, at most `most_points`.
Json describe_motion(
    const IdentifyRequest& r, const MeasurementResult& result, Warnings& warnings) {
    const std::vector<double>& all = r.measurement.record.tau;
    const std::size_t every = (all.size() + r.most_points - 1) / r.most_points;
    std::vector<double> moments;
    for (std::size_t k = 0; k < all.size(); k += every) moments.push_back(all[k]);
    if (every > 1)
        warnings.push_back(fmt::format(
            "the motion is given at one of {} samples, so that it holds at most max_points = {}",
            every, r.most_points));
    const std::vector<OscillatorMotion> motion = motion_at(result.refined->fit, moments);
    Json j = {{quantity.tau.name, column(moments)}};
    j.update(describe(fitted_motion_columns, motion));
    return j;
}

/// Warnings about the fit of a record.
void add_fit_warnings(
    const IdentifyRequest& r, const MeasurementResult& result, Warnings& warnings) {
    const FoundImpacts& refined = *result.refined;
    const Identification& found = result.found;
    const double omega0 = r.system.si->omega0();
    if (!refined.dropped.empty())
        warnings.push_back(fmt::format(
            "{} spike(s) without a jump of the velocity were dropped, the first at {:.6g} s",
            refined.dropped.size(), refined.dropped[0] / omega0));
    add_fitted_warnings(refined.fit, given_unknowns(r.measurement.parameters), omega0, warnings);
    if (result.parameters.b != r.system.parameters.b)
        warnings.push_back(fmt::format(
            "the impacts' momentum fits b = {:.5g} m, which is used instead of b = {:.5g} m ({})",
            result.parameters.b, r.system.parameters.b, r.system.origin.at("b")));
    if (!b_agrees(result.parameters, found))
        warnings.push_back(fmt::format(
            "the impacts' momentum fits b = {:.4g} m, not b = {:.4g} m ({})", found.b_fitted,
            result.parameters.b, r.system.origin.at("b")));
    if (!std::isfinite(found.b_fitted))
        warnings.push_back(
            std::string("no b is fitted to the impacts' momentum: ") + text_of(found.b_fault));
    // Which pulses are seen is advice only where the impacts are right.
    if (!result.doubts.empty() || result.continuity.is_incomplete() ||
        r.measurement.record.x_ddot.empty())
        return;
    const std::string advice = sampling_advice(refined, r.measurement.step(), omega0);
    if (!advice.empty()) warnings.push_back(advice);
}

/// Warnings about impacts that are missing, were restored or are left out.
void add_continuity_warnings(const MeasurementResult& result, Warnings& warnings) {
    const Continuity& c = result.continuity;
    const std::vector<IdentifiedImpact>& impacts = result.found.impacts;
    const auto hidden = std::ranges::count_if(
        impacts, [](const IdentifiedImpact& i) { return i.is_hidden && !i.comes_to_rest; });
    const auto sticks = sticking_phases(impacts).size();
    const auto listed = std::ranges::count(impacts, false, &IdentifiedImpact::comes_to_rest);
    if (hidden > 0 || sticks > 0)
        warnings.push_back(fmt::format(
            "{} impact(s) and {} sticking phase(s) {} were inserted: a simulation of the "
            "identified system passes through them from one impact to the next",
            hidden, sticks, result.refined ? "without a pulse" : "missing from the list"));
    if (c.left_out > 0)
        warnings.push_back(fmt::format(
            "{} of {} impacts are inconsistent and left out; impacts.status gives the reasons",
            c.left_out, listed));
    if (c.missing > 0)
        warnings.push_back(fmt::format(
            "between {} pair(s) of impacts the ball did not fly freely, and no simulation of the "
            "identified system leads from one to the other: an impact is missing or false, or the "
            "record has a gap",
            c.missing));
    if (c.stretches.size() > 1)
        warnings.push_back(fmt::format(
            "the impacts form {} stretches: qr combines all of them, eigenvalues and raw_product "
            "use the longest",
            c.stretches.size()));
}

/// Reasons against a verdict from this measurement; empty if it is sound.
std::vector<std::string> all_doubts(const MeasurementResult& result) {
    auto doubts = texts_of(result.doubts, [](Doubt doubt) { return text_of(doubt); });
    if (result.continuity.is_incomplete())
        doubts.insert(
            doubts.begin(),
            fmt::format(
                "{:.3g} % of the impacts are left out or missing, more than {:.3g} %",
                100 * result.continuity.share, 100 * Continuity::most));
    return doubts;
}

/// The request's system with the identified values.
System identified_system(const IdentifyRequest& r, const MeasurementResult& result) {
    System used = r.system;
    used.parameters = result.parameters;
    const std::string measured = r.measurement.is_record() ? "record" : "impacts";
    if (!r.measurement.R_given)
        used.origin["R_plus"] = used.origin["R_minus"] = "estimated from the impacts";
    if (r.forcing_fitted) {
        if (used.si) used.si->F = result.parameters.G * result.parameters.epsilon;
        used.origin["G"] = "fitted to the " + measured;
        if (used.si) used.origin["F"] = used.origin["G"];
    }
    if (r.measurement.is_record()) {
        if (!result.refined->fit.fixed[Unknown::Omega]) {
            used.si->f = result.parameters.Omega * used.si->f0();
            used.origin["f"] = used.origin["Omega"] = "fitted to the record";
        }
        if (used.parameters.b != r.system.parameters.b) used.origin["b"] = "fitted to the record";
    }
    return used;
}

MeasurementResult watched_result(const IdentifyRequest& r, const IdentificationWatch& watch) {
    try {
        return evaluate_measurement(r.measurement, watch);
    } catch (const TooFewImpacts& few) {
        if (!r.measurement.impact_times.empty())
            refuse("/impact_times_s", "at fewer than two of the given times the velocity jumps");
        throw Problem(
            422,
            fmt::format(
                "no impacts found in the record: {} pulse(s) or kink(s) with threshold = {:g} "
                "standard deviations of the noise",
                few.seen, r.measurement.threshold),
            {{"/threshold", r.measurement.threshold, Json::array({3, 1000}),
              "lower threshold, or give impact_times_s"}});
    } catch (const TooManyImpacts&) {
        throw Problem(
            413, fmt::format(
                     "the record shows more than {} impacts, this server's limit: send a shorter "
                     "record or give a higher threshold",
                     watch.most_impacts));
    } catch (const IdentificationStopped& at) {
        const std::size_t samples = r.measurement.record.tau.size();
        throw Problem(
            413, fmt::format(
                     "the identification was stopped while {} ({}): a shorter record, fewer "
                     "samples per second or a higher threshold takes less time",
                     words_of(at.stage, at.round),
                     samples > 0 ? fmt::format("a record of {} samples", samples)
                                 : fmt::format("{} impacts", r.measurement.impacts.size())));
    }
}

}  // namespace

std::string words_of(IdentificationStage stage, int round) {
    switch (stage) {
        case IdentificationStage::spikes: return "looking for spikes";
        case IdentificationStage::impacts:
            return "refining the impacts" + (round > 0 ? fmt::format(", round {}", round) : "");
        case IdentificationStage::exponents: break;
    }
    return "computing the exponents";
}

Json identify_answer(const IdentifyRequest& r, const IdentificationWatch& watch) {
    const Measurement& m = r.measurement;
    const MeasurementResult result = watched_result(r, watch);
    const std::vector<std::string> doubts = all_doubts(result);
    Warnings warnings = r.system.notes;
    if (result.refined) add_fit_warnings(r, result, warnings);
    add_continuity_warnings(result, warnings);
    if (m.laws.any() && !result.laws)
        warnings.push_back(
            "the laws of the ball in fit do not settle: the record does not determine them");
    for (const std::string& doubt : doubts) warnings.push_back("no verdict: " + doubt);

    const System used = identified_system(r, result);
    const Identification& found = result.found;
    const IdentifiedExponents& judged = result.judged;
    Json answer = {{"version", version()}, {"parameters", describe_system(used)}};
    make_room(answer, most_parts);
    if (result.refined) {
        answer["signal"] = describe_signal(m, result, r.system.si->omega0());
        answer["signal"]["forcing"] =
            r.forcing ? describe_measured_forcing(*r.forcing, used, result.refined->fit, warnings)
                      : Json(nullptr);
        answer["fitted"] =
            describe_fitted(result.refined->fit, result.parameters, r.system.si->omega0());
    }
    if (m.laws.any()) answer["laws"] = describe_laws(result.laws, m.laws, r.system.si->omega0());
    answer["impacts"] = describe_identified(found.impacts);
    answer["sticking"] = describe(sticking_columns, sticking_phases(found.impacts));
    answer["restitution"] = describe_walls(found);
    answer["b_fitted"] = describe(properties::fitted_b, found);
    answer["exponents"] =
        describe_measured(result.exponents, result.continuity.stretches, found.impacts, warnings);
    answer["slope"] = describe(properties::slope, judged.slope);
    answer["verdict"] = enum_json(judged.verdict);
    answer["verdict_reason"] = doubts.empty() ? reason_of(judged) : doubts[0];
    if (m.is_record()) {
        answer["direct"] = describe_direct(r, result.direct, warnings);
        if (r.include.contains("motion")) answer["motion"] = describe_motion(r, result, warnings);
        answer["forward"] = describe_forward(result.forward);
    }
    if (r.system.si)
        for (const char* part : {"impacts", "sticking", "exponents", "motion", "direct", "forward"})
            if (answer.contains(part)) add_si(answer[part], *r.system.si);
    answer["warnings"] = warnings;
    return answer;
}

}  // namespace vines::api
