#include "api/design.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

#include "api/describe.hpp"
#include "api/json_text.hpp"
#include "api/properties.hpp"
#include "api/schema/enum_names.hpp"
#include "api/version.hpp"
#include "core/sweep/basins.hpp"

namespace vines::api {

namespace {

/// Null without a band.
Json frequency(const DesignRequest& r, double f) {
    return r.plan.host.is_harmonic() ? Json(f) : Json(nullptr);
}

Json described(const DesignRequest& r, const DesignPoint& p) {
    return {
        {"b", p.b},
        {"R", p.R},
        {"m2", p.m2},
        {r.objective, finite_or_null(p.objective)},
        {"f", frequency(r, p.f)},
        {r.excitation->amplitude, p.amplitude * r.amplitude}};
}

Json described(const DesignRequest& r, const BandMaximum& m) {
    return {{r.objective, finite_or_null(m.value)}, {"f", frequency(r, m.f)}};
}

Json described(const DesignRequest& r, const LinearAbsorber& t, const BandMaximum& m) {
    Json j = described(r, m);
    j.update(
        {{"frequency_ratio", finite_or_null(t.frequency_ratio)},
         {"damping_ratio", finite_or_null(t.damping_ratio)}});
    return j;
}

Json described(const DesignMargin& m) {
    return {{"five_percent", m.five_percent}, {"twenty_percent", m.twenty_percent}};
}

/// "48.9 mm".
std::string quantity_text(const DesignRequest& r, double value) {
    if (std::isinf(value)) return "infinite";
    switch (r.plan.objective) {
        case Objective::x_acceleration_max: return fmt::format("{:.3g} m/s^2", value);
        case Objective::impact_speed_max: return fmt::format("{:.3g} m/s", value);
        case Objective::decay_time: return fmt::format("{:.3g} s", value);
        default: return fmt::format("{:.3g} mm", 1000 * value);
    }
}

/// Which absorber to build, in words.
std::string recommendation_of(const DesignRequest& r, const Design& d) {
    const double value = d.best.objective, without = d.without.value,
                 damper = d.with_tuned_mass_damper.value;
    std::string text = fmt::format(
        "A cavity with b = {:.3g} mm and R = {:.2g} for a ball of {:.3g} g keeps {}{} at {} {}",
        1000 * d.best.b, d.best.R, 1000 * d.best.m2, r.plan.mean ? "the mean of " : "", r.objective,
        quantity_text(r, value), r.excitation->where);
    if (std::isnan(damper)) return text + ".";  // an objective of impacts, or a stopped search
    text += fmt::format(
        "; without absorber it is {}, with a tuned mass damper of the same mass (frequency ratio "
        "{:.3g}, damping ratio {:.2g}) {}",
        quantity_text(r, without), d.tuned_mass_damper.frequency_ratio,
        d.tuned_mass_damper.damping_ratio, quantity_text(r, damper));
    constexpr double clearly = 0.9;
    if (!(value < clearly * without) && !(damper < clearly * without))
        return text + ". Neither helps.";
    if (!(value < clearly * without))
        return text + ". The cavity does not help: build the tuned mass damper.";
    if (damper < clearly * value) return text + ". Build the tuned mass damper.";
    return text + (value < clearly * damper ? ". Build the cavity." : ". Both are equally good.");
}

/// The worst case of the best absorber, in words.
std::string limit_of(const DesignRequest& r, const Design& d) {
    if (!d.complete || r.plan.mean || r.plan.host.load) return "";
    const RegimeType type = d.at_worst.regime.type;
    return fmt::format(
        " The worst case of the cavity is at {}{:.3g} {}{}.",
        r.plan.host.is_harmonic() ? fmt::format("{:.4g} Hz and ", d.best.f) : "",
        d.best.amplitude * r.amplitude, r.excitation->unit,
        type == RegimeType::none ? "" : fmt::format(", in a motion of type {}", name_of(type)));
}

/// In ascending order.
std::vector<double> objectives(const std::vector<ToleranceSample>& samples) {
    std::vector<double> values;
    for (const ToleranceSample& s : samples) values.push_back(s.point.objective);
    std::ranges::sort(values);
    return values;
}

/// The result in words.
std::string sentence_of(const DesignRequest& r, const Design& d) {
    std::string text = recommendation_of(r, d) + limit_of(r, d);
    if (d.samples.empty()) return text;
    return fmt::format(
        "{} With these tolerances {}{} stays below {} in 95 % of the samples.", text,
        r.plan.mean ? "the mean of " : "", r.objective,
        quantity_text(r, quantile(objectives(d.samples), 0.95)));
}

Json response_columns(const DesignRequest& r, const Design& d) {
    const auto list = [&](double DesignResponse::* member) { return column(d.response, member); };
    return {
        {"f", column(d.response, [&](const DesignResponse& at) { return frequency(r, at.f); })},
        {r.objective + "_worst_start", list(&DesignResponse::worst)},
        {r.objective + "_best_start", list(&DesignResponse::best)},
        {"without", list(&DesignResponse::without)},
        {"tuned_mass_damper", list(&DesignResponse::tuned_mass_damper)},
        {"impact_speed_max", list(&DesignResponse::impact_speed)},
        {"impulse_max", list(&DesignResponse::impulse)},
        {"impacts_per_second", list(&DesignResponse::impacts_per_second)}};
}

Json sample_line(const DesignRequest& r, const ToleranceSample& s) {
    Json values = Json::object();
    for (const Tolerance& t : r.plan.tolerances) {
        const double unit = t.what == Toleranced::amplitude ? r.amplitude : 1;
        values[name_in(r, t.what)] = unit * value_of(s.built, t.what);
    }
    Json line = {{"type", "sample"}, {"index", s.index}, {"values", std::move(values)}};
    line.update(described(r, s.point));
    line["regime"] = s.worst ? Json(name_of(s.worst->regime.type)) : Json(nullptr);
    line["verdict"] = s.worst ? enum_json(s.worst->verdict) : Json(nullptr);
    return line;
}

/// The fractions of samples by the value that `of` returns for each, with 95 % intervals.
template <class Of>
Json fractions(const std::vector<ToleranceSample>& samples, const char* name, Of of) {
    std::map<Json, std::size_t> counts;
    for (const ToleranceSample& s : samples) ++counts[s.worst ? of(*s.worst) : Json(nullptr)];
    Json list = Json::array();
    const auto all = static_cast<double>(samples.size());
    for (const auto& [value, count] : counts) {
        const auto k = static_cast<double>(count);
        list.push_back(
            {{name, value},
             {"samples", count},
             {"fraction", k / all},
             {"interval", binomial_interval(k, all)}});
    }
    return list;
}

Json described(const DesignRequest& r, const std::vector<ToleranceSample>& samples) {
    constexpr std::array probabilities = {0.05, 0.25, 0.5, 0.75, 0.95};
    const std::vector<double> values = objectives(samples);
    return {
        {"samples", samples.size()},
        {"probability", column(probabilities)},
        {r.objective,
         column(probabilities, [&](double p) { return finite_or_null(quantile(values, p)); })},
        {"regimes",
         fractions(
             samples, "regime", [](const PointResult& p) { return Json(name_of(p.regime.type)); })},
        {"verdicts",
         fractions(samples, "verdict", [](const PointResult& p) { return enum_json(p.verdict); })}};
}

Json described(const DesignRequest& r, const Design& d) {
    Json best = described(r, d.best);
    if (d.complete) {
        const auto most = [&](double DesignResponse::* member) {
            return std::ranges::max(d.response, {}, member).*member;
        };
        best.update(
            {{"regime",
              r.plan.host.is_harmonic() ? Json(name_of(d.at_worst.regime.type)) : Json(nullptr)},
             {"impact_speed_max", most(&DesignResponse::impact_speed)},
             {"impulse_max", most(&DesignResponse::impulse)},
             {"impacts_per_second", most(&DesignResponse::impacts_per_second)},
             {"margins",
              {{"b", described(d.b)},
               {"R", described(d.R)},
               {"f0", described(d.f0)},
               {"damping", described(d.damping)}}},
             {"works_from", d.works.from * r.amplitude},
             {"works_to", d.works.to * r.amplitude},
             {"activation", d.activation ? Json(*d.activation * r.amplitude) : Json(nullptr)}});
        if (r.plan.objective == Objective::impact_speed_max)
            best[r.objective] = finite_or_null(d.best.objective);
    }
    Json line = {
        {"type", "done"},
        {"complete", d.complete},
        {"best", std::move(best)},
        {"without", described(r, d.without)},
        {"tuned_mass_damper", described(r, d.tuned_mass_damper, d.with_tuned_mass_damper)},
        {"den_hartog", described(r, d.den_hartog, d.with_den_hartog)},
        {"response", response_columns(r, d)},
        {"sentence", sentence_of(r, d)}};
    if (!r.plan.tolerances.empty()) line["tolerances"] = described(r, d.samples);
    return line;
}

class DesignLines : public LineStream {
public:
    explicit DesignLines(DesignRequest r) : r_(std::move(r)) {}

    std::string begin() const override {
        return json_line(
            {{"type", "start"},
             {"version", version()},
             {"commit", commit()},
             {"runs_of", design_runs(r_.plan)},
             {"b_from", r_.plan.b.from},
             {"b_to", r_.plan.b.to},
             {"host", describe(properties::host, r_.host)},
             {"request", r_.given}});
    }
    bool compute(int threads, RunControl& control, const Take& take) override {
        design_ = find_design(
            r_.plan, threads, control,
            [&](const DesignPoint& p) {
                Json line = {{"type", "point"}};
                line.update(described(r_, p));
                take(json_line(std::move(line)));
                ++count_;
            },
            [&](const ToleranceSample& s) { take(json_line(sample_line(r_, s))); });
        return design_ && design_->complete;
    }
    std::string progress(std::size_t, const RunControl& control, double) const override {
        return json_line(
            {{"type", "progress"},
             {"done", count_.load()},
             {"runs", control.runs.load()},
             {"runs_of", std::max(design_runs(r_.plan), control.runs.load())}});
    }
    std::size_t bytes(int threads) const override {
        if (!r_.given.contains("forcing")) return 0;
        return static_cast<std::size_t>(threads) *
               ForcingField(r_.given["forcing"]).bytes(r_.plan.host.si.f0());
    }
    std::string end() override { return design_ ? json_line(described(r_, *design_)) : ""; }
    const char* remedy() const override { return "request fewer R, b_count, f_count or cycles"; }

private:
    const DesignRequest r_;
    std::optional<Design> design_;
    std::atomic<std::size_t> count_ = 0;
};

}  // namespace

std::shared_ptr<LineStream> design_lines(DesignRequest request) {
    return std::make_shared<DesignLines>(std::move(request));
}

}  // namespace vines::api
