// Figs. 3 and 4: the strongly modulated response at b = 22 mm. The amplitude of x rises with fewer
// than two impacts per cycle and falls with two.
#include <fmt/format.h>

#include "report/chapters.hpp"
#include "report/plots.hpp"

namespace vines::report {

namespace {

/// Mean numbers of impacts in the cycles over which the amplitude of x falls and rises.
struct ImpactsPerCycle {
    double falling, rising;
};

ImpactsPerCycle impacts_per_cycle(const Response& r) {
    double falling = 0, rising = 0;
    long falling_cycles = 0, rising_cycles = 0;
    auto impact = r.run.impacts.begin();
    const ManifoldResult& half_cycles = *r.run.manifold;
    for (std::size_t k = 3; k < half_cycles.points.size(); k += 2) {
        long n = 0;
        for (; impact != r.run.impacts.end() && impact->tau <= half_cycles.tau[k]; ++impact) ++n;
        const bool falls = half_cycles.points[k].C < half_cycles.points[k - 2].C;
        (falls ? falling : rising) += static_cast<double>(n);
        ++(falls ? falling_cycles : rising_cycles);
    }
    return {
        falling / static_cast<double>(falling_cycles), rising / static_cast<double>(rising_cycles)};
}

void figure_3(Report& report, const Response& r, const Response& by_equation) {
    Plot x = displacement(series_until(0.022, 5521.3));
    x.moments = {18.13, 1708.9};
    report.picture(
        {.name = "fig3",
         .caption = "Fig. 3: displacement of the linear oscillator; the window of Fig. 5 between "
                    "the broken lines",
         .plots = {x}});
    report.find(
        {.where = "Fig. 3",
         .what = "regime",
         .paper = "Type II",
         .here = fmt::format(
             "{}, {} half cycles in step", r.type(), r.run.regime->longest_synchronised),
         .verdict = reproduced,
         .number = number_of(r.run.regime->type),
         .band = exactly(number_of(RegimeType::II))});
    const double first = r.run.impacts.front().tau;
    report.find(
        {.where = "Fig. 3",
         .what = "first impact, tau_s",
         .paper = "18.1300",
         .here =
             fmt::format("{:.4f} ({:.4f} by eq. (1))", first, by_equation.run.impacts.front().tau),
         .verdict = reproduced_with_closed_form,
         .number = first,
         .band = {18.11, 18.15}});
}

void figure_4(Report& report, const Response& r) {
    report.picture(
        {.name = "fig4",
         .caption = "Fig. 4: displacement and relative displacement, enlarged",
         .plots = {displacement(*r.run.series, 600), relative_displacement(r, 0, 600)}});
    const auto [falling, rising] = impacts_per_cycle(r);
    report.find(
        {.where = "Fig. 4",
         .what = "impacts per cycle while x falls / rises",
         .paper = "2 / below 2",
         .here = fmt::format("{:.2f} / {:.2f}", falling, rising),
         .verdict = reproduced,
         .number = falling - rising,
         .band = {0.4, 2}});
}

}  // namespace

void strongly_modulated(Report& report, Runs& runs) {
    report.heading("Figs. 3 and 4: strongly modulated response, b = 22 mm (Type II)");
    const Response& r = runs.response(0.022);
    figure_3(report, r, runs.response(0.022, Damping::equation_of_motion));
    figure_4(report, r);
}

}  // namespace vines::report
