// Figs. 3 and 4: the strongly modulated response at b = 22 mm. The amplitude of x rises while there
// are fewer than two impacts per cycle and falls while there are two.
#include <fmt/format.h>

#include "report/claims.hpp"
#include "report/plots.hpp"

namespace vines::report {

namespace {

/// Mean number of impacts per cycle while the amplitude of x falls, and while it rises.
struct ImpactsPerCycle {
    double falling, rising;
};

ImpactsPerCycle impacts_per_cycle(const PaperRun& r) {
    double falling = 0, rising = 0, falling_cycles = 0, rising_cycles = 0;
    auto impact = r.run.impacts.begin();
    const ManifoldResult& half_cycles = *r.run.manifold;
    for (std::size_t k = 3; k < half_cycles.points.size(); k += 2) {
        const bool falls = half_cycles.points[k].C < half_cycles.points[k - 2].C;
        for (; impact != r.run.impacts.end() && impact->tau <= half_cycles.tau[k]; ++impact)
            ++(falls ? falling : rising);
        ++(falls ? falling_cycles : rising_cycles);
    }
    return {falling / falling_cycles, rising / rising_cycles};
}

double first_impact_of(const Parameters& p) {
    AnalysisRequest wanted{.parameters = p, .start = default_state(p), .tau_end = 30};
    wanted.parts = {.impacts = true};
    return analyse(wanted).impacts.front().tau;
}

void first_impact(Report& report, const BothRuns& runs) {
    const PaperRun& r = runs.here;
    Parameters rounded = r.parameters;
    rounded.epsilon = 0.0084;
    rounded.lambda = 1.43;
    const double tau = r.run.impacts.front().tau, other = runs.by_equation.run.impacts.front().tau;
    report.add(
        {"Table 2", "first impact, tau_s (Fig. 3)", "18.1300"},
        {tau, other,
         fmt::format(
             "{:.4f}; {:.4f} with epsilon and lambda as printed; by eq. (1) {:.4f}", tau,
             first_impact_of(rounded), other)},
        {{18.12995, 18.13005},
         "the printed digits; in part: a tenth of a per cent",
         Band{18.1119, 18.1481}},
        ClaimVerdict::partly_by_closed_form);
}

void figure_3(Report& report, const BothRuns& runs) {
    Plot x = displacement(*run_until(runs.here.parameters, 5521.3, {.series = true}).run.series);
    x.marked_times = {18.13, 1708.9};
    report.picture(
        "fig3",
        "Fig. 3: displacement of the linear oscillator; the window of Fig. 5 between "
        "the dashed lines",
        {x});
    same_regime(
        report, "Fig. 3", RegimeType::II, runs,
        fmt::format(
            "{}, {} synchronised half cycles; by eq. (1) {}", runs.here.type(),
            runs.here.regime().longest_synchronised, runs.by_equation.type()));
    first_impact(report, runs);
}

void figure_4(Report& report, const BothRuns& runs) {
    const PaperRun& r = runs.here;
    report.picture(
        "fig4", "Fig. 4: displacement and relative displacement, enlarged",
        {displacement(*r.run.series, 600), relative_displacement(r, 0, 600)});
    const ImpactsPerCycle here = impacts_per_cycle(r), other = impacts_per_cycle(runs.by_equation);
    report.add(
        {"Fig. 4", "impacts per cycle while x falls", "2"},
        result("{:.2f}", here.falling, other.falling),
        {{1.9, 2.1}, "cycles in which x turns are counted with either side"});
    report.add(
        {"Fig. 4", "impacts per cycle while x rises", "below 2"},
        result("{:.2f}", here.rising, other.rising), {{0, 1.9}, "as the row above"});
}

}  // namespace

void strongly_modulated(Report& report, RunCache& runs) {
    report.heading("Figs. 3 and 4: strongly modulated response, b = 22 mm (Type II)");
    figure_3(report, runs.both(0.022));
    figure_4(report, runs.both(0.022));
}

}  // namespace vines::report
