// Figs. 6 to 9: the moduli of the eigenvalues of J (flight), M (impact) and T = M J at b = 22 mm. J
// contracts, M has the moduli 1, 1, R, R, and only T is large; its largest modulus is almost
// constant while the motion is synchronised with the forcing, two impacts per cycle.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <span>

#include "core/stability/linear.hpp"
#include "report/claims.hpp"

namespace vines::report {

namespace {

/// Moduli of one of the three matrices at each impact: the largest `count` of them.
Plot moduli(
    const PaperRun& r, const std::string& label, const std::vector<Moduli>& of, int count = 4) {
    constexpr const char* names[] = {"largest", "second", "third", "smallest"};
    Plot plot{.x_label = "tau", .y_label = label, .levels = {1}};
    for (int k = 0; k < count; ++k) {
        Curve curve{.x = r.run.moduli->tau, .colour = colours[k], .label = names[k], .dots = true};
        for (const Moduli& values : of) curve.y.push_back(values[k]);
        plot.curves.push_back(std::move(curve));
    }
    return plot;
}

/// Largest deviation of J's moduli from 1, 1 and e^(-zeta Delta tau), in flights without sticking.
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

/// Largest factor by which J multiplies the length of a deviation (x', x): its block's norm.
double factor_of_oscillator(const PaperRun& r) {
    double largest = 0;
    for (const Matrix4& J : r.run.matrices->J) {
        const double rotation = elementary::hypot(J(0, 0) + J(1, 1), J(0, 1) - J(1, 0)),
                     reflection = elementary::hypot(J(0, 0) - J(1, 1), J(0, 1) + J(1, 0));
        largest = std::max(largest, (rotation + reflection) / 2);
    }
    return largest;
}

/// Median deviation of M's moduli from 1, 1, R, R: near grazing rounding of its entries dominates.
double error_of_M(const PaperRun& r) {
    const double R = r.parameters.R_plus;  // of both walls
    std::vector<double> errors;
    for (const Matrix4& matrix : r.run.matrices->M) {
        Moduli M;
        std::ranges::transform(eigenvalues_of(matrix), M.begin(), elementary::modulus);
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

/// Factor by which M multiplies a deviation of x - y alone, median over the impacts.
double factor_of_displacement(const PaperRun& r) {
    std::vector<double> factors;
    for (const Matrix4& M : r.run.matrices->M)  // g^T M applied to the deviation x = 1
        factors.push_back(std::abs(M(1, 1) - M(3, 1)));
    return median(factors);
}

void figures_6_to_8(Report& report, const PaperRun& r) {
    Plot T = moduli(r, "|eig T|", r.run.moduli->T);
    T.logarithmic = true;
    report.picture(
        "fig6-8",
        "Figs. 6, 7, 8: moduli of the eigenvalues of J, M and T; of J and M the first two "
        "coincide, and the last two",
        {moduli(r, "|eig J|", r.run.moduli->J), moduli(r, "|eig M|", r.run.moduli->M), T}, 170);
    report.add(
        {"Fig. 6", "moduli of J: their distance from e^(-zeta Delta tau) twice and 1 twice",
         "two below 1, two 1"},
        result("{:.0e}", error_of_J(r)), {{0, 1e-12}, "an identity: only rounding is left"});
    report.add(
        {"Fig. 6", "largest factor of the length of a deviation (x', x) in a flight",
         "\"the initial difference of LO will decrease\""},
        result("{:.4f}", factor_of_oscillator(r)),
        {{0, 1 + 1e-12}, "at most 1 in each flight, plus rounding: its x'^2 + x^2 only falls"});
    report.add(
        {"Fig. 7", "moduli of M: their distance from 1, 1, R, R (median of the impacts)",
         "two 1, two R"},
        result("{:.0e}", error_of_M(r)),
        {{0, 1e-12}, "an identity: only rounding is left, which is larger near grazing"});
    // The paper continues: the difference of velocity is "decreased by impact with a reduction
    // coefficient R".
    report.add(
        {"Fig. 7", "factor of a difference of x - y at an impact",
         "\"the initial difference of displacement will not be changed ... by themselves\""},
        result("{:.4f}: R, as that of x' - y'", factor_of_displacement(r)),
        {{0.999, 1.001}, "1 if unchanged; the factor of each impact is exact except for rounding"},
        not_reproduced);
    report.add(
        {"Fig. 8", "largest modulus of T, at its largest", "very large"},
        result("{:.1f}", maximum_of_T(r, 0)), {{10, infinity}, "an order above 1"});
    report.add(
        {"Fig. 8", "second modulus of T, at its largest", "very large"},
        result("{:.2f}", maximum_of_T(r, 1)),
        {{10, infinity}, "an order above 1; in part: above 1", Band{1, infinity}}, partly);
}

using Intervals = std::vector<std::pair<double, double>>;

Intervals synchronised_stretches(const PaperRun& r) {
    Intervals stretches;
    for (const SynchronyStretch& s : r.regime().stretches)
        if (s.synchronised) stretches.emplace_back(s.tau_start, s.tau_end);
    return stretches;
}

/// The synchronised impacts of a run, or the others, and the growth of ln of the largest deviation
/// (qr) up to them.
struct ImpactGroup {
    /// T's largest modulus, without those impacts of a chatter that are so close to each other that
    /// rounding hides it.
    std::vector<double> T;
    double growth = 0, tau = 0;  ///< and its duration

    double rate() const { return growth / tau; }  ///< per unit of tau
    double above_one() const {
        return fraction(T, [](double t) { return t > 1; });
    }
    std::vector<double> ln_T() const {
        std::vector<double> logarithms;
        for (const double t : T) logarithms.push_back(elementary::log(t));
        return logarithms;
    }
    double spread_of_ln_T() const { return quantile(ln_T(), 0.75) - quantile(ln_T(), 0.25); }
    /// The growth if moduli of single T composed.
    double growth_by_T() const {
        const std::vector<double> ln = ln_T();
        return std::accumulate(ln.begin(), ln.end(), 0.);
    }
};
struct ImpactGroups {
    ImpactGroup synchronised, desynchronised;

    double ratio_of_rates() const { return synchronised.rate() / desynchronised.rate(); }
    double growth_by_T_over_growth() const {
        return (synchronised.growth_by_T() + desynchronised.growth_by_T()) /
               (synchronised.growth + desynchronised.growth);
    }
};

ImpactGroups groups_of(const PaperRun& r) {
    const Intervals stretches = synchronised_stretches(r);
    ImpactGroups found;
    const auto group_at = [&](double tau) -> ImpactGroup& {
        const bool is_synchronised = std::ranges::any_of(
            stretches, [tau](const auto& s) { return tau > s.first && tau <= s.second; });
        return is_synchronised ? found.synchronised : found.desynchronised;
    };
    const TransferModuli& moduli = *r.run.moduli;
    for (std::size_t i = 0; i < moduli.tau.size(); ++i)
        if (!std::isnan(moduli.T[i][0])) group_at(moduli.tau[i]).T.push_back(moduli.T[i][0]);
    const ExponentHistory& qr = r.product().qr_history();
    const double start = r.product().start_tau();
    for (std::size_t i = 1; i < qr.tau.size(); ++i) {
        const double from = qr.tau[i - 1], to = qr.tau[i];
        ImpactGroup& g = group_at(to);
        g.growth += qr.lambda[i][0] * (to - start) - qr.lambda[i - 1][0] * (from - start);
        g.tau += to - from;
    }
    return found;
}

/// A number of the runs at 22 mm from neighbouring starts.
Typical typical_of_groups(RunCache& runs, Damping damping, auto number) {
    return typical(
        runs.neighbours(0.022, damping), [&](const PaperRun& r) { return number(groups_of(r)); });
}
/// The same with both dampings.
Result at_22_mm(RunCache& runs, int decimals, auto number) {
    return result_of(
        typical_of_groups(runs, Damping::closed_form, number),
        typical_of_groups(runs, Damping::equation_of_motion, number), decimals);
}

/// "Greater than one in area1 and less than one in area2."
void areas_1_and_2(Report& report, RunCache& runs) {
    const Criterion nine_in_ten = {{0.9, 1}, "nine in ten; in part: more than half", Band{0.5, 1}};
    report.add(
        {"Fig. 9, area 1",
         "not synchronised: fraction of impacts where T's largest modulus is above 1",
         "greater than one (a typical example)"},
        at_22_mm(runs, 2, [](const ImpactGroups& g) { return g.desynchronised.above_one(); }),
        nine_in_ten, partly);
    report.add(
        {"Fig. 9, area 2", "synchronised: fraction of impacts where it is below 1",
         "less than one (a typical example)"},
        at_22_mm(runs, 2, [](const ImpactGroups& g) { return 1 - g.synchronised.above_one(); }),
        nine_in_ten, partly_by_equation_of_motion);
    report.add(
        {"Fig. 9",
         "its spread (quartiles of ln) while not synchronised, over that while synchronised",
         "changes a lot / almost the same value"},
        at_22_mm(
            runs, 1,
            [](const ImpactGroups& g) {
                return g.desynchronised.spread_of_ln_T() / g.synchronised.spread_of_ln_T();
            }),
        {{4, infinity}, "several times as much"});
}

/// Long enough for several synchronised stretches, before an orbit captures the motion at 22 mm.
constexpr double tau_of_stretches = 10000;

/// "The essence of chaotic is the irregular and desynchronized impacts": at each b of Type II.
void where_chaos_comes_from(Report& report, RunCache& runs) {
    Report::Rows rows;
    const auto cell = [](double synchronised, double desynchronised) {
        return fmt::format("{:.4f} / {:.4f}", synchronised, desynchronised);
    };
    constexpr double nearly_none = 0.1;
    double largest = -infinity, largest_other = -infinity;
    std::vector<double> mm_above;
    for (const Table3Row& row : printed_table_3) {
        if (row.b > highest_of_type_II) continue;
        const auto long_run = [&](Damping damping) {
            return groups_of(run_until(
                table1(row.b, damping), tau_of_stretches,
                {.exponents = true, .moduli = true, .regime = true}, {.qr = true}));
        };
        const ImpactGroups here = long_run(Damping::closed_form);
        largest = std::max(largest, here.ratio_of_rates());
        if (here.ratio_of_rates() > nearly_none) mm_above.push_back(1000 * row.b);
        rows.push_back(
            {fmt::format("{:g}", 1000 * row.b),
             cell(here.synchronised.rate(), here.desynchronised.rate()), "periodic",
             cell(
                 here.synchronised.growth_by_T() / here.synchronised.tau,
                 here.desynchronised.growth_by_T() / here.desynchronised.tau)});
        if (runs.paper_run(row.b, Damping::equation_of_motion).regime().orbit) continue;
        const ImpactGroups other = long_run(Damping::equation_of_motion);
        largest_other = std::max(largest_other, other.ratio_of_rates());
        rows.back()[2] = cell(other.synchronised.rate(), other.desynchronised.rate());
    }
    const std::string quantity =
        "growth of ln of the largest deviation (qr) while synchronised, over that while not";
    const Criterion nearly_all = {
        {-infinity, nearly_none}, "nearly all growth occurs while not synchronised"};
    report.add(
        {"Section 4.1", "b = 22 mm: " + quantity, "chaos results from desynchronised impacts"},
        at_22_mm(runs, 2, std::mem_fn(&ImpactGroups::ratio_of_rates)), nearly_all);
    report.add(
        {"Section 4.2", "Type II (16.5 to 31 mm): " + quantity + ", the largest of the eight b",
         "the same"},
        {largest, largest_other, "{:.2f}; above a tenth at {:g} mm; by eq. (1) {:.2f}", largest,
         fmt::join(mm_above, ", "), largest_other},
        nearly_all, by_equation_of_motion);
    report.paragraph(fmt::format(
        "Growth of ln of the largest deviation (qr) per unit of tau, while synchronised and while "
        "not, up to tau = {:g}, and the sum of the logarithms of T's largest modulus, which it "
        "would be if moduli of single T composed:",
        tau_of_stretches));
    report.table(
        {"b (mm)", "growth while synchronised / while not", "by eq. (1)",
         "sum of ln of T's largest modulus"},
        rows);
}

/// Half the Frobenius norm of T over its largest modulus, median of the impacts: at most 1 if T is
/// normal, since the norm is then the root of the sum of the squared moduli.
double departure_from_normal(const PaperRun& r) {
    std::vector<double> ratios;
    for (std::size_t i = 0; i < r.run.matrices->T.size(); ++i)
        if (const double modulus = r.run.moduli->T[i][0]; !std::isnan(modulus))
            ratios.push_back(r.run.matrices->T[i].norm() / 2 / modulus);
    return median(ratios);
}

/// "The results here demonstrate more details": those of single T.
void single_matrices(Report& report, RunCache& runs) {
    Result found = at_22_mm(runs, 2, std::mem_fn(&ImpactGroups::growth_by_T_over_growth));
    found.words += fmt::format(
        ". Half the Frobenius norm of T_i over its largest modulus: {:.1f} (median), at most 1 for "
        "a normal matrix",
        departure_from_normal(runs.paper_run(0.022)));
    report.add(
        {"Section 4.1",
         "b = 22 mm: sum of ln of T_i's largest moduli, over the growth of ln of the largest "
         "deviation (qr)",
         "the eigenvalues of T_i \"demonstrate more details and reveal the essence of chaos\""},
        found,
        {{0.8, 1.25}, "1 if the moduli of single T_i composed into growth; within a quarter"},
        not_reproduced);
    const auto median_of = [&](auto number) {
        return typical_of_groups(runs, Damping::closed_form, number).median;
    };
    report.bottom_line += fmt::format(
        " Deviations grow while the impacts are not synchronised ({:.3f} per unit of tau at b = 22 "
        "mm, {:.3f} while they are), as the paper says; but the moduli of single T_i, from which "
        "it concludes this, do not compose into growth, and the largest exceeds one at {:.2f} of "
        "the synchronised impacts, too.",
        median_of([](const ImpactGroups& g) { return g.desynchronised.rate(); }),
        median_of([](const ImpactGroups& g) { return g.synchronised.rate(); }),
        median_of([](const ImpactGroups& g) { return g.synchronised.above_one(); }));
}

/// The values at the times in (from, to].
template <class Value>
std::span<const Value> between(
    const std::vector<double>& tau, const std::vector<Value>& values, double from, double to) {
    return {
        values.begin() + (std::ranges::upper_bound(tau, from) - tau.begin()),
        values.begin() + (std::ranges::upper_bound(tau, to) - tau.begin())};
}

/// Largest modulus of T and largest |x| between the ends of consecutive synchronised stretches.
struct Modulation {
    double T = 0, x = 0;
};

std::vector<Modulation> modulations(const PaperRun& r) {
    const Intervals stretches = synchronised_stretches(r);
    std::vector<Modulation> found;
    for (std::size_t k = 1; k < stretches.size(); ++k) {
        const double from = stretches[k - 1].second, to = stretches[k].second;
        Modulation m;
        for (const Moduli& T : between(r.run.moduli->tau, r.run.moduli->T, from, to))
            m.T = std::max(m.T, T[0]);
        for (const double x : between(r.run.series->tau, r.run.series->x, from, to))
            m.x = std::max(m.x, std::abs(x));
        found.push_back(m);
    }
    return found;
}

/// "Two typical examples": counts the synchronised stretches that begin with such an area 2.
void example_of_area_2(Report& report, const PaperRun& r) {
    double examples = 0, stretches = 0;
    for (const auto& [from, to] : synchronised_stretches(r)) {
        const auto first_half = between(r.run.moduli->tau, r.run.moduli->T, from, (from + to) / 2);
        examples += std::ranges::all_of(first_half, [](const Moduli& T) { return T[0] < 1; });
        ++stretches;
    }
    report.add(
        {"Fig. 9, area 2", "synchronised stretches in whose first half it is always below 1",
         "less than one (a typical example)"},
        {examples / stretches, "{} of {}", examples, stretches},
        {{0.9, 1},
         "nine in ten, if typical; in part: one. The half stands for \"area 2\", whose "
         "extent the paper does not state",
         Band{1 / stretches, 1}},
        partly);
}

/// "In area3, the largest value is observed and it has a close relation to the maximal amplitude of
/// modulated displacement."
void area_3(Report& report, const std::vector<PaperRun>& neighbours) {
    std::vector<bool> is_highest;
    for (const PaperRun& r : neighbours) {
        const std::vector<Modulation> shown = modulations(r);
        if (!shown.empty())
            is_highest.push_back(
                std::ranges::max_element(shown, {}, &Modulation::T) ==
                std::ranges::max_element(shown, {}, &Modulation::x));
    }
    const double runs = fraction(is_highest, std::identity{});
    report.add(
        {"Fig. 9, area 3",
         "fraction of runs from neighbouring starts whose largest T is in the modulation with the "
         "highest amplitude",
         "in area3, the largest value is observed; \"a close relation to the maximal amplitude\""},
        {runs, "{:.2f} of {} runs, {} that from the paper's start", runs, is_highest.size(),
         is_highest.front() ? "also" : "but not"},
        {{0.9, 1}, "nine in ten; in part: more than half", Band{0.5, 1}}, partly);
    const PaperRun r = run_until(
        neighbours[0].parameters, 10 * window_end,
        {.series = true, .moduli = true, .regime = true});
    std::vector<double> T, x;
    for (const Modulation& m : modulations(r)) T.push_back(m.T), x.push_back(m.x);
    const double correlation = rank_correlation(T, x);
    report.add(
        {"Fig. 9, area 3",
         "rank correlation of T's largest modulus and the amplitude, over the modulations",
         "a close relation"},
        {correlation, "{:.2f} over the {} modulations up to tau = {:g}", correlation, T.size(),
         r.run.outcome.tau},
        {{0.8, 1},
         "close; in part: more than chance gives once in 100 times, 2.58 over the root "
         "of their number less one",
         Band{2.58 / std::sqrt(static_cast<double>(T.size()) - 1), 1}},
        partly);
}

void figure_9(Report& report, RunCache& runs) {
    const PaperRun& r = runs.paper_run(0.022);
    Plot x = displacement(*r.run.series), T = moduli(r, "|eig T|, largest", r.run.moduli->T, 1);
    T.logarithmic = true;
    x.bands = T.bands = synchronised_stretches(r);
    T.curves.push_back({.colour = colours[1], .label = "shaded: synchronised", .dots = true});
    report.picture(
        "fig9", "Fig. 9: x and the largest modulus of T; synchronised stretches shaded", {x, T});
    areas_1_and_2(report, runs);
    example_of_area_2(report, r);
    area_3(report, runs.neighbours(0.022));
    where_chaos_comes_from(report, runs);
    single_matrices(report, runs);
}

}  // namespace

void transfer_matrices(Report& report, RunCache& runs) {
    report.heading("Figs. 6 to 9: eigenvalues of J, M and T, b = 22 mm");
    figures_6_to_8(report, runs.paper_run(0.022));
    figure_9(report, runs);
}

}  // namespace vines::report
