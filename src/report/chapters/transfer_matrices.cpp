// Figs. 6 to 9: the moduli of the eigenvalues of J (flight), M (impact) and T = M J at b = 22 mm.
// J contracts, M has 1, 1, R, R, and only T is large; its largest modulus is almost constant while
// the motion is in step with the forcing, two impacts per cycle.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/chapters.hpp"
#include "report/plots.hpp"

namespace vines::report {

namespace {

/// The k-th moduli (of 0 to 3, descending) of one of the three matrices at each impact.
Plot moduli(
    const Response& r, const std::string& label, const std::vector<Moduli>& of,
    const std::vector<int>& which = {0, 1, 2, 3}) {
    Plot plot{.x_label = "tau", .y_label = label, .levels = {1}};
    for (int k : which) {
        Curve curve{.x = r.run.moduli->tau, .colour = colours[k], .dots = true};
        for (const Moduli& values : of) curve.y.push_back(values[k]);
        plot.curves.push_back(std::move(curve));
    }
    return plot;
}

/// By how much J's moduli miss 1, 1 and e^(-zeta Delta tau), where no stick came between: that
/// leaves none of two deviations.
double error_of_J(const Response& r) {
    const TransferModuli& moduli = *r.run.moduli;
    double error = 0, tau_before = r.run.impacts.front().tau;
    for (std::size_t i = 0; i < moduli.tau.size(); ++i) {
        const Moduli& J = moduli.J[i];
        const double decay = std::exp(-r.parameters.zeta() * (moduli.tau[i] - tau_before));
        if (J[3] > 0)
            error =
                std::max({error, std::abs(J[3] - decay), std::abs(J[0] - 1), std::abs(J[1] - 1)});
        tau_before = moduli.tau[i];
    }
    return error;
}

/// By how much those of M, from its entries, miss 1, 1, R, R at the median impact: near grazing the
/// entries are so large that rounding has the last word.
double error_of_M(const Response& r) {
    const double R = r.parameters.R_plus;  // of both walls
    std::vector<double> errors;
    for (const Matrix4& matrix : r.run.matrices->M) {
        const Moduli M = eigenvalue_moduli(matrix);
        errors.push_back(std::max(
            {std::abs(M[0] - 1), std::abs(M[1] - 1), std::abs(M[2] - R), std::abs(M[3] - R)}));
    }
    return median(errors);
}

double largest_of_T(const Response& r) {
    double largest = 0;
    for (const Moduli& T : r.run.moduli->T) largest = std::max(largest, T[0]);
    return largest;
}

void figures_6_to_8(Report& report, const Response& r) {
    Plot T = moduli(r, "|eig T|", r.run.moduli->T);
    T.logarithmic = true;
    report.picture(
        {.name = "fig6-8",
         .caption = "Figs. 6, 7, 8: moduli of the eigenvalues of J, M and T",
         .plots = {moduli(r, "|eig J|", r.run.moduli->J), moduli(r, "|eig M|", r.run.moduli->M), T},
         .height = 170});
    const double J_error = error_of_J(r), M_error = error_of_M(r), largest = largest_of_T(r);
    report.find(
        {.where = "Fig. 6",
         .what = "moduli of J",
         .paper = "two below 1, two 1",
         .here = fmt::format("e^(-zeta Delta tau) twice, 1 twice, to {:.0e}", J_error),
         .verdict = reproduced,
         .number = J_error,
         .band = {0, 1e-12}});
    report.find(
        {.where = "Fig. 7",
         .what = "moduli of M",
         .paper = "1, 1, R, R",
         .here = fmt::format("1, 1, .6, .6 to {:.0e}", M_error),
         .verdict = reproduced,
         .number = M_error,
         .band = {0, 1e-6}});
    report.find(
        {.where = "Fig. 8",
         .what = "largest modulus of T",
         .paper = "very large, above 1",
         .here = fmt::format("{:.1f}", largest),
         .verdict = reproduced,
         .number = largest,
         .band = {10, 1e4}});
}

using Intervals = std::vector<std::pair<double, double>>;

Intervals synchronised_stretches(const Regime& regime) {
    Intervals stretches;
    for (const SynchronyStretch& s : regime.stretches)
        if (s.synchronised) stretches.emplace_back(s.tau_start, s.tau_end);
    return stretches;
}

/// Between the quartiles.
double spread(const std::vector<double>& v) { return quantile(v, 0.75) - quantile(v, 0.25); }

void figure_9(Report& report, const Response& r) {
    const Intervals stretches = synchronised_stretches(*r.run.regime);
    Plot x = displacement(*r.run.series), T = moduli(r, "|eig T|, largest", r.run.moduli->T, {0});
    T.logarithmic = true;
    x.bands = T.bands = stretches;
    report.picture(
        {.name = "fig9",
         .caption = "Fig. 9: x and the largest modulus of T; synchronised stretches shaded",
         .plots = {x, T}});

    std::vector<double> in_step, out_of_step;  // ln of the largest modulus
    for (std::size_t i = 0; i < r.run.moduli->tau.size(); ++i) {
        const double tau = r.run.moduli->tau[i];
        const bool synchronised = std::ranges::any_of(
            stretches, [tau](const auto& s) { return tau > s.first && tau <= s.second; });
        (synchronised ? in_step : out_of_step).push_back(std::log(r.run.moduli->T[i][0]));
    }
    report.find(
        {.where = "Fig. 9",
         .what = "spread (quartiles of ln) of T's largest modulus, in step / not",
         .paper = "almost constant / changes a lot",
         .here = fmt::format(
             "{:.2f} around {:.2f} / {:.2f} around {:.2f}", spread(in_step),
             std::exp(median(in_step)), spread(out_of_step), std::exp(median(out_of_step))),
         .verdict = reproduced,
         .number = spread(out_of_step) / spread(in_step),
         .band = {4, 1e3}});
}

}  // namespace

void transfer_matrices(Report& report, Runs& runs) {
    report.heading("Figs. 6 to 9: eigenvalues of J, M and T, b = 22 mm");
    const Response& r = runs.response(0.022);
    figures_6_to_8(report, r);
    figure_9(report, r);
}

}  // namespace vines::report
