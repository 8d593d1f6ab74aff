#include "statement.hpp"

#include <limits>

#include "api/json_text.hpp"
#include "api/simulate.hpp"

namespace vines::hunt {

namespace {

constexpr long max_impacts_of_request = 500000;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

Verdict verdict_named(const api::Json& name) {
    return name.is_null()      ? Verdict::none
           : name == "chaotic" ? Verdict::chaotic
           : name == "regular" ? Verdict::regular
                               : Verdict::not_decided;
}

double number(const api::Json& value) { return value.is_number() ? value.get<double>() : nan; }

}  // namespace

Statement sweep_point(const System& system, int transient, int cycles) {
    const Parameters& p = system.parameters;
    PointOptions options;
    options.transient_cycles = transient;
    options.cycles = cycles;
    options.max_impacts = max_impacts_of_request;
    const PointResult r = measure(p, system.start, options, {});
    Statement s{};
    s.interface =
        "sweep, " + std::to_string(transient) + " + " + std::to_string(cycles) + " cycles";
    s.start = simulate(
                  p, system.start,
                  {transient * p.cycle(), transient * transient_impacts_per_cycle, {}}, {})
                  .state;
    s.cycles = cycles;
    s.complete = r.measured && r.outcome.reason == End::tau_end;
    s.verdict = r.verdict;
    s.lambda1 = r.lambda[0];
    s.error = r.standard_error[0];
    s.periodic = r.regime.orbit.has_value();
    if (s.periodic) {
        s.period = r.regime.orbit->cycles;
        s.symmetric = r.regime.orbit->symmetric;
    }
    if (r.regime.capture && r.regime.capture->tau)
        s.captured_at = *r.regime.capture->tau / p.cycle();
    s.chaotic_before = r.regime.capture && r.chaotic_cycles;
    if (const auto& q = r.regime.quasi_periodic)
        s.quasi_periodic = {q->rotation_number, q->error, q->curves};
    s.type = name_of(r.regime.type);
    s.request = request(
        system, "\"transient_cycles\":" + std::to_string(transient) +
                    ",\"cycles\":" + std::to_string(cycles));
    return s;
}

Statement simulation(const System& system, int cycles) {
    Statement s{};
    s.interface = "simulation, " + std::to_string(cycles) + " cycles";
    s.start = system.start;
    s.cycles = cycles;
    s.covers_start = true;
    s.request = request(
        system, "\"cycles\":" + std::to_string(cycles) +
                    ",\"max_impacts\":" + std::to_string(max_impacts_of_request) +
                    ",\"include\":[\"exponents\",\"regime\"],\"exponents\":[\"qr\"]");
    const api::Json answer = api::Json::parse(api::json_text(
        api::simulate_in_parts(api::read_simulate_request(api::Json::parse(s.request)), {}).json));
    const api::Json &exponents = answer["exponents"], &regime = answer["regime"];
    s.complete = answer["status"]["reason"] == "tau_end";
    s.verdict = verdict_named(exponents["verdict"]);
    s.lambda1 = number(exponents["qr"]["final"][0]);
    s.error = number(exponents["qr"]["standard_error"][0]);
    s.periodic = regime["periodic"] == true;
    if (s.periodic) {
        s.period = regime["period_cycles"];
        s.symmetric = regime["symmetric"];
    }
    if (regime["capture"].is_object()) {
        const api::Json& tau = regime["capture"]["tau"];
        if (tau.is_number()) s.captured_at = tau.get<double>() / system.parameters.cycle();
        s.chaotic_before = regime["capture"]["chaotic_before"] == true;
    }
    if (const api::Json& q = regime["quasi_periodic"]; q.is_object())
        s.quasi_periodic = {q["rotation_number"], number(q["standard_error"]), q["curves"]};
    s.type = regime["type"];
    return s;
}

}  // namespace vines::hunt
