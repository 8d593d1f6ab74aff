#include <cmath>
#include <string>

#include "../core/measurement/laboratory.hpp"
#include "core/analysis/analysis.hpp"
#include "core/measurement/measurement.hpp"
#include "core/sweep/sweep.hpp"
#include "parts.hpp"
#include "table.hpp"

namespace vines::bench {

namespace {

constexpr double endless = 1e12;

std::string power(double count) { return "1e" + std::to_string(std::lround(std::log10(count))); }

/// For a motion with two impacts in every cycle. At b = 22 mm, an orbit with a chatter captures the
/// motion after 30,000 cycles, and cycles no longer have equal cost.
AnalysisRequest exponents_alone() {
    AnalysisRequest w;
    w.parameters.b = 0.015;
    w.parameters.damping = Damping::closed_form;
    w.start = default_state(w.parameters);
    w.parts.exponents = true;
    w.estimators = qr_alone;
    return w;
}

void bench_run(double cycles) {
    const int rounds = cycles < 1e6 ? 5 : 1;
    const auto run = [cycles] {
        AnalysisRequest w = exponents_alone();
        w.tau_end = cycles * w.parameters.cycle();
        w.max_impacts = 1000000000;
        w.window = {0, w.tau_end};
        return 1e9 * seconds_of([&] { analyse(w); }) / cycles;
    };
    row("a run of " + power(cycles) + " cycles, b = 15 mm, exponents alone",
        in_turn(rounds, {run})[0], "ns per cycle");
}

class Nowhere : public SweepSink {
public:
    void point(std::size_t, const SweepPoint&) override {}
    void row(std::size_t, const RowSummary&) override {}
};

void short_sweep(std::size_t points) {
    SweepPlan plan;
    plan.grid.steps = {points};
    plan.options = {.transient_cycles = 5, .cycles = 10};
    for (std::size_t k = 0; k < points; ++k) plan.lines.push_back(k);
    plan.system_at = [points](const Place& place) {
        Parameters p;
        p.b = 0.002 + 0.038 * static_cast<double>(place.at[0]) / static_cast<double>(points);
        return std::optional(PointSystem{p, default_state(p), 100000});
    };
    RunControl control;
    Nowhere sink;
    run_sweep(plan, 2, control, sink);
}

void bench_memory() {
    for (std::size_t points : {100, 10000})
        row("memory of a sweep of " + power(static_cast<double>(points)) +
                " points, 5 settling and 10 measured cycles",
            {cost_of([points] { short_sweep(points); }).megabytes}, "MB");
    for (long impacts : {200000, 2000000}) {
        const Cost run = cost_of([impacts] {
            AnalysisRequest w = exponents_alone();
            w.tau_end = endless;
            w.window = {0, endless};
            w.max_impacts = impacts;
            analyse(w);
        });
        row("a run of " + std::to_string(impacts) + " impacts, b = 15 mm, exponents alone",
            {run.seconds}, "s", ", " + digits(run.megabytes) + " MB of memory");
    }
}

/// Record of a regular motion, which never sticks; 2048 samples per second.
Measurement record_of(double samples) {
    const TrueMotion motion = test::settled_motion(0.008, 0.6, 0.6, samples / 2048);
    const test::Experiment e = test::measured(motion, test::Sensors{});
    return {.parameters = e.parameters, .record = e.record, .estimators = qr_alone};
}

void bench_identification(double samples, int rounds) {
    const Measurement measurement = record_of(samples);
    std::vector<double> seconds;
    double megabytes = 0;
    for (int k = 0; k < rounds; ++k) {
        const Cost cost = cost_of([&] { evaluate_measurement(measurement); });
        seconds.push_back(cost.seconds);
        megabytes = cost.megabytes;
    }
    const std::string name =
        samples < 1e6 ? "a record of 41,000 samples" : "a record of 1,000,000 samples";
    row(name + " identified", seconds, "s",
        ", " + digits(megabytes) + " MB of memory in addition to the record");
}

}  // namespace

void bench_growth(bool long_too) {
    bench_memory();
    bench_identification(41000, 5);
    if (long_too) bench_identification(1e6, 1);
    for (double cycles : {1e3, 1e4, 1e5}) bench_run(cycles);
    if (long_too) bench_run(1e6);
}

}  // namespace vines::bench
