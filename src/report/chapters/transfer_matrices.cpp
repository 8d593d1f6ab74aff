// Figs. 6 to 9: the moduli of the eigenvalues of J (flight), M (impact) and T = M J at b = 22 mm. J
// contracts, M has the moduli 1, 1, R, R, and only T is large; its largest modulus is almost
// constant while the motion is synchronised with the forcing, two impacts per cycle.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/plots.hpp"
#include "report/report.hpp"
#include "report/runs.hpp"

#include "core/motion/elementary.hpp"

namespace vines::report {

namespace {

/// Moduli of one of the three matrices at each impact; `which`: 0 to 3, descending.
Plot moduli(
    const PaperRun& r, const std::string& label, const std::vector<Moduli>& of,
    const std::vector<int>& which = {0, 1, 2, 3}) {
    Plot plot{.x_label = "tau", .y_label = label, .levels = {1}};
    for (int k : which) {
        Curve curve{.x = r.run.moduli->tau, .colour = colours[k], .dots = true};
        for (const Moduli& values : of) curve.y.push_back(values[k]);
        plot.curves.push_back(std::move(curve));
    }
    return plot;
}

/// Largest deviation of J's moduli from 1, 1 and e^(-zeta Delta tau), without flights that contain
/// a sticking phase, which removes two deviations.
double error_of_J(const PaperRun& r) {
    const TransferModuli& moduli = *r.run.moduli;
    double error = 0, tau_before = r.run.impacts.front().tau;
    for (std::size_t i = 0; i < moduli.tau.size(); ++i) {
        const Moduli& J = moduli.J[i];
        const double decay = elementary::exp(-r.parameters.zeta() * (moduli.tau[i] - tau_before));
        if (J[3] > 0)
            error =
                std::max({error, std::abs(J[3] - decay), std::abs(J[0] - 1), std::abs(J[1] - 1)});
        tau_before = moduli.tau[i];
    }
    return error;
}

/// Median deviation of the moduli of M, computed from its entries, from 1, 1, R, R. Near grazing
/// the entries are so large that rounding dominates.
double error_of_M(const PaperRun& r) {
    const double R = r.parameters.R_plus;  // of both walls
    std::vector<double> errors;
    for (const Matrix4& matrix : r.run.matrices->M) {
        const Moduli M = eigenvalue_moduli(matrix);
        errors.push_back(std::max(
            {std::abs(M[0] - 1), std::abs(M[1] - 1), std::abs(M[2] - R), std::abs(M[3] - R)}));
    }
    return median(errors);
}

double maximum_of_T(const PaperRun& r, int k) {
    double largest = 0;
    for (const Moduli& T : r.run.moduli->T) largest = std::max(largest, T[k]);
    return largest;
}

void figures_6_and_7(Report& report, const PaperRun& r) {
    const double J_error = error_of_J(r), M_error = error_of_M(r);
    report.add(
        {.where = "Fig. 6",
         .what = "moduli of J: their distance from e^(-zeta Delta tau) twice and 1 twice",
         .paper = "two below 1, two 1",
         .here = fmt::format("{:.0e}", J_error),
         .number = J_error,
         .band = {0, 1e-12},
         .because = "an identity: only rounding is left"});
    report.add(
        {.where = "Fig. 7",
         .what = "moduli of M: their distance from 1, 1, R, R (median of the impacts)",
         .paper = "two 1, two R",
         .here = fmt::format("{:.0e}", M_error),
         .number = M_error,
         .band = {0, 1e-12},
         .because = "an identity: only rounding is left, which is larger near grazing"});
}

/// Factor by which M multiplies a deviation of x - y alone, median over the impacts.
double factor_of_displacement(const PaperRun& r) {
    std::vector<double> factors;
    for (const Matrix4& M : r.run.matrices->M)  // g^T M applied to the deviation x = 1
        factors.push_back(std::abs(M(1, 1) - M(3, 1)));
    return median(factors);
}

/// "The initial difference of displacement will not be changed during the impact", and that of
/// velocity is "decreased by impact with a reduction coefficient R".
void what_M_does(Report& report, const PaperRun& r) {
    const double factor = factor_of_displacement(r);
    report.add(
        {.where = "Fig. 7",
         .what = "factor of a difference of x - y at an impact",
         .paper =
             "\"the initial difference of displacement will not be changed ... by themselves\"",
         .here = fmt::format("{:.4f}: R, as that of x' - y'", factor),
         .number = factor,
         .band = {0.999, 1.001},
         .because = "1 if unchanged; the factor of each impact is exact except for rounding",
         .expected = ClaimVerdict::not_reproduced});
}

void figure_8(Report& report, const PaperRun& r) {
    const double first = maximum_of_T(r, 0), second = maximum_of_T(r, 1);
    report.add(
        {.where = "Fig. 8",
         .what = "largest modulus of T, at its largest",
         .paper = "very large",
         .here = fmt::format("{:.1f}", first),
         .number = first,
         .band = {10, infinity},
         .because = "an order above 1"});
    report.add(
        {.where = "Fig. 8",
         .what = "second modulus of T, at its largest",
         .paper = "very large",
         .here = fmt::format("{:.2f}", second),
         .number = second,
         .band = {10, infinity},
         .because = "an order above 1; in part: above 1",
         .partly = Band{1, infinity},
         .expected = ClaimVerdict::partly});
}

void figures_6_to_8(Report& report, const PaperRun& r) {
    Plot T = moduli(r, "|eig T|", r.run.moduli->T);
    T.logarithmic = true;
    report.picture(
        {.name = "fig6-8",
         .caption = "Figs. 6, 7, 8: moduli of the eigenvalues of J, M and T",
         .plots = {moduli(r, "|eig J|", r.run.moduli->J), moduli(r, "|eig M|", r.run.moduli->M), T},
         .height = 170});
    figures_6_and_7(report, r);
    what_M_does(report, r);
    figure_8(report, r);
}

using Intervals = std::vector<std::pair<double, double>>;

Intervals synchronised_stretches(const Regime& regime) {
    Intervals stretches;
    for (const SynchronyStretch& s : regime.stretches)
        if (s.synchronised) stretches.emplace_back(s.tau_start, s.tau_end);
    return stretches;
}

bool is_inside(const Intervals& stretches, double tau) {
    return std::ranges::any_of(
        stretches, [tau](const auto& s) { return tau > s.first && tau <= s.second; });
}

/// T's largest modulus in and outside synchronised stretches; without those impacts of a chatter
/// that are so close to each other that rounding hides it.
struct LargestOfT {
    std::vector<double> synchronised, desynchronised;
};

LargestOfT largest_of_T(const PaperRun& r, const Intervals& stretches) {
    LargestOfT found;
    for (std::size_t i = 0; i < r.run.moduli->tau.size(); ++i) {
        if (std::isnan(r.run.moduli->T[i][0])) continue;
        const bool synchronised = is_inside(stretches, r.run.moduli->tau[i]);
        (synchronised ? found.synchronised : found.desynchronised).push_back(r.run.moduli->T[i][0]);
    }
    return found;
}

double above_one(const std::vector<double>& v) {
    return static_cast<double>(std::ranges::count_if(v, [](double x) { return x > 1; })) /
           static_cast<double>(v.size());
}

/// Interquartile range of the logarithms.
double log_spread(std::vector<double> v) {
    for (double& x : v) x = elementary::log(x);
    return quantile(v, 0.75) - quantile(v, 0.25);
}

/// Statistics of a number computed from the largest moduli of each run.
template <class Number>
Typical typical_largest_of_T(const std::vector<PaperRun>& runs, Number number) {
    return typical(runs, [&](const PaperRun& r) {
        return number(largest_of_T(r, synchronised_stretches(*r.run.regime)));
    });
}

/// "Greater than one in area1 and less than one in area2."
void areas_1_and_2(Report& report, RunCache& runs) {
    const auto of = [&](auto number) {
        return std::pair{
            typical_largest_of_T(runs.neighbours(0.022), number),
            typical_largest_of_T(runs.neighbours(0.022, Damping::equation_of_motion), number)};
    };
    const auto out = of([](const LargestOfT& T) { return above_one(T.desynchronised); });
    const auto in = of([](const LargestOfT& T) { return 1 - above_one(T.synchronised); });
    const auto spread = of([](const LargestOfT& T) {
        return log_spread(T.desynchronised) / log_spread(T.synchronised);
    });
    constexpr Band nearly_all = {0.9, 1}, most_of_them = {0.5, 1};
    const std::string nine_in_ten = "nine in ten; in part: more than half";
    report.add(
        {.where = "Fig. 9, area 1",
         .what = "not synchronised: fraction of impacts where T's largest modulus is above 1",
         .paper = "greater than one (a typical example)",
         .here = out.first.in_words(2),
         .number = out.first.median,
         .by_equation = out.second.median,
         .band = nearly_all,
         .because = nine_in_ten,
         .partly = most_of_them,
         .expected = ClaimVerdict::partly});
    report.add(
        {.where = "Fig. 9, area 2",
         .what = "synchronised: fraction of impacts where it is below 1",
         .paper = "less than one (a typical example)",
         .here = fmt::format("{}; by eq. (1) {}", in.first.in_words(2), in.second.in_words(2)),
         .number = in.first.median,
         .by_equation = in.second.median,
         .band = nearly_all,
         .because = nine_in_ten,
         .partly = most_of_them,
         .expected = ClaimVerdict::partly_by_equation_of_motion});
    report.add(
        {.where = "Fig. 9",
         .what =
             "its spread (quartiles of ln) while not synchronised, over that while synchronised",
         .paper = "changes a lot / almost the same value",
         .here = spread.first.in_words(1),
         .number = spread.first.median,
         .by_equation = spread.second.median,
         .band = {4, infinity},
         .because = "several times as much"});
}

/// Growth rate of ln of the largest deviation (qr) in and outside synchronised stretches.
struct GrowthRates {
    double synchronised, desynchronised;  ///< per unit of tau
};
GrowthRates growth_rates(const PaperRun& r, const Intervals& stretches) {
    const ExponentHistory& qr = r.run.exponents->product.qr_history();
    const double start = r.run.exponents->product.start_tau();
    double grown[2] = {0, 0}, lasted[2] = {0, 0};
    for (std::size_t i = 1; i < qr.tau.size(); ++i) {
        const double from = qr.tau[i - 1], to = qr.tau[i];
        const bool synchronised = is_inside(stretches, to);
        grown[synchronised] +=
            qr.lambda[i][0] * (to - start) - qr.lambda[i - 1][0] * (from - start);
        lasted[synchronised] += to - from;
    }
    return {grown[1] / lasted[1], grown[0] / lasted[0]};
}

/// "The essence of chaotic is the irregular and desynchronized impacts."
void where_chaos_comes_from(Report& report, RunCache& runs) {
    const auto of = [&](Damping damping) {
        const PaperRun& r = runs.paper_run(0.022, damping);
        return growth_rates(r, synchronised_stretches(*r.run.regime));
    };
    const GrowthRates here = of(Damping::closed_form), other = of(Damping::equation_of_motion);
    report.add(
        {.where = "Section 4.1",
         .what = "b = 22 mm: growth of ln of the largest deviation (qr) while synchronised, over "
                 "that while not",
         .paper = "chaos results from desynchronised impacts",
         .here = fmt::format(
             "{:.4f} / {:.4f} per unit of tau; by eq. (1) {:.4f} / {:.4f}", here.synchronised,
             here.desynchronised, other.synchronised, other.desynchronised),
         .number = here.synchronised / here.desynchronised,
         .by_equation = other.synchronised / other.desynchronised,
         .band = {-infinity, 0.1},
         .because = "nearly all growth occurs while not synchronised"});
}

/// Largest modulus of T and largest |x| between the ends of consecutive synchronised stretches.
struct Modulation {
    double T, x;
};

std::vector<Modulation> modulations(const PaperRun& r, const Intervals& stretches) {
    std::vector<Modulation> found;
    for (std::size_t k = 1; k < stretches.size(); ++k) {
        const double from = stretches[k - 1].second, to = stretches[k].second;
        Modulation m{0, 0};
        const TransferModuli& moduli = *r.run.moduli;
        for (std::size_t i = 0; i < moduli.tau.size(); ++i)
            if (moduli.tau[i] > from && moduli.tau[i] <= to) m.T = std::max(m.T, moduli.T[i][0]);
        const Series& series = *r.run.series;
        for (std::size_t i = 0; i < series.tau.size(); ++i)
            if (series.tau[i] > from && series.tau[i] <= to)
                m.x = std::max(m.x, std::abs(series.x[i]));
        found.push_back(m);
    }
    return found;
}

/// "Area1 and area2 are two typical examples": counts the synchronised stretches that begin with
/// such an area 2.
void example_of_area_2(Report& report, const PaperRun& r, const Intervals& stretches) {
    const TransferModuli& moduli = *r.run.moduli;
    double examples = 0;
    for (const auto& [from, to] : stretches) {
        bool below = true;
        for (std::size_t i = 0; i < moduli.tau.size(); ++i)
            if (moduli.tau[i] > from && moduli.tau[i] <= (from + to) / 2)
                below = below && moduli.T[i][0] < 1;
        examples += below;
    }
    report.add(
        {.where = "Fig. 9, area 2",
         .what = "synchronised stretches in whose first half it is always below 1",
         .paper = "less than one (a typical example)",
         .here = fmt::format("{} of {}", examples, stretches.size()),
         .number = examples / static_cast<double>(stretches.size()),
         .band = {0.9, 1},
         .because = "nine in ten, if typical; in part: one. The half stands for \"area 2\", whose "
                    "extent the paper does not state",
         .partly = Band{1 / static_cast<double>(stretches.size()), 1},
         .expected = ClaimVerdict::partly});
}

/// "In area3, the largest value is observed and it has a close relation to the maximal amplitude of
/// modulated displacement."
void area_3(Report& report, const std::vector<PaperRun>& neighbours) {
    const Typical higher = typical(neighbours, [](const PaperRun& r) {
        const std::vector<Modulation> shown = modulations(r, synchronised_stretches(*r.run.regime));
        if (shown.empty()) return nan;
        const double at_largest_T = std::ranges::max_element(shown, {}, &Modulation::T)->x;
        return static_cast<double>(
            std::ranges::count_if(shown, [&](const Modulation& m) { return m.x > at_largest_T; }));
    });
    report.add(
        {.where = "Fig. 9, area 3",
         .what = "number of the window's modulations with a higher amplitude than the one with the "
                 "largest value of T",
         .paper = "in area3, the largest value is observed; \"a close relation to the maximal "
                  "amplitude\"",
         .here = higher.in_words(0),
         .number = higher.median,
         .band = exactly(0),
         .because = "area3 is at the maximal amplitude"});
    const PaperRun r = long_response(0.022);
    std::vector<double> T, x;
    for (const Modulation& m : modulations(r, synchronised_stretches(*r.run.regime)))
        T.push_back(m.T), x.push_back(m.x);
    const double correlation = rank_correlation(T, x);
    report.add(
        {.where = "Fig. 9, area 3",
         .what = "rank correlation of T's largest modulus and the amplitude, over the modulations",
         .paper = "a close relation",
         .here = fmt::format(
             "{:.2f} over the {} modulations up to tau = {:g}", correlation, T.size(),
             r.run.outcome.tau),
         .number = correlation,
         .band = {0.8, 1},
         .because = "close; in part: more than chance gives once in 100 times, 2.58 over the root "
                    "of their number less one",
         .partly = Band{2.58 / std::sqrt(static_cast<double>(T.size()) - 1), 1},
         .expected = ClaimVerdict::partly});
}

void figure_9(Report& report, RunCache& runs) {
    const PaperRun& r = runs.paper_run(0.022);
    const Intervals stretches = synchronised_stretches(*r.run.regime);
    Plot x = displacement(*r.run.series), T = moduli(r, "|eig T|, largest", r.run.moduli->T, {0});
    T.logarithmic = true;
    x.bands = T.bands = stretches;
    report.picture(
        {.name = "fig9",
         .caption = "Fig. 9: x and the largest modulus of T; synchronised stretches shaded",
         .plots = {x, T}});
    areas_1_and_2(report, runs);
    example_of_area_2(report, r, stretches);
    area_3(report, runs.neighbours(0.022));
    where_chaos_comes_from(report, runs);
}

}  // namespace

void transfer_matrices(Report& report, RunCache& runs) {
    report.heading("Figs. 6 to 9: eigenvalues of J, M and T, b = 22 mm");
    figures_6_to_8(report, runs.paper_run(0.022));
    figure_9(report, runs);
}

}  // namespace vines::report
