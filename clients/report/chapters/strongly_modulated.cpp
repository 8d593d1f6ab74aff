// The strongly modulated response at b = 22 mm, Type II.
//
// Figs. 3 and 4: the motion. The amplitude of x rises while there are fewer than two impacts per
// cycle and falls while there are two.
//
// Fig. 5: the transient Lyapunov exponents. The paper finds all four positive, and attributes their
// spikes to grazing. But the exponents' sum is negative by the sum rule (lyapunov.hpp), and the
// spikes of lambda1 are zero crossings of the product's leading eigenvalue.
//
// Table 2: the exponents over three windows of one run. After a few hundred units of tau a chaotic
// run is one of many possible ones, so the three printed numbers together are compared with their
// distribution over many windows of several runs.
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "report/claims.hpp"

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
    Parameters rounded = runs.here.parameters;
    rounded.epsilon = 0.0084;
    rounded.lambda = 1.43;
    const double tau = runs.here.run.impacts.front().tau,
                 other = runs.by_equation.run.impacts.front().tau;
    report.add(
        {"Table 2", "first impact, tau_s (Fig. 3)", "18.1300"},
        {tau, other, "{:.4f}; {:.4f} with epsilon and lambda as printed; by eq. (1) {:.4f}", tau,
         run_until(rounded, 30, {.impacts = true}).run.impacts.front().tau, other},
        {{18.12995, 18.13005},
         "the printed digits; in part: a tenth of a per cent",
         Band{18.1119, 18.1481}},
        partly_by_closed_form);
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

namespace {

double sum_of(const Exponents& l) { return l[0] + l[1] + l[2] + l[3]; }

/// Window length from which on the product in double precision has lost the k-th exponent.
double rounded_from(const Exponents& qr, int k) {
    return -elementary::log(std::numeric_limits<double>::epsilon()) / (qr[0] - qr[k]);
}

std::ptrdiff_t sticking_phases(const PaperRun& r) {
    return std::ranges::count_if(r.run.sticks, [&](const StickingPhase& s) {
        return s.start.tau > r.product().start_tau();
    });
}

/// The first of the starts with y 10, 20, ... nm beside the paper's whose window has no sticking
/// phase, after which lambda3, lambda4 and the sum are minus infinity; and its run.
std::pair<double, PaperRun> run_without_sticking(const Parameters& p) {
    constexpr int most_tried = 50;
    State start = default_state(p);
    const double y = start.y;
    for (int k = 1;; ++k) {
        start.y = y - 1e-8 * k;
        PaperRun run =
            run_until(p, window_end, {.exponents = true}, {.qr = true, .raw_product = true}, start);
        if (sticking_phases(run) == 0 || k == most_tried) return {start.y, std::move(run)};
    }
}

/// Limits of a product in double precision: what it retains of the exponents, and for how long.
void limits_of_the_computer(Report& report, double y, const TransferProduct& product) {
    const Exponents qr = product.qr(), raw = product.raw_product();
    const double T = product.end_tau() - product.start_tau(),
                 range = elementary::log(std::numeric_limits<double>::max());
    report.paragraph(fmt::format(
        "The exponents add up to -2 zeta + (2/T) (sum of ln R), for any motion: they cannot all be "
        "positive. \"Too large value of transfer matrix M in Eq. (32) will exceed the capability "
        "of computer\": from y(0) = {:.8f} m its entries overflow at T = {:.0f}; but rounding "
        "hides lambda3 from T = {:.0f} on, and lambda2 from {:.0f} on. The unscaled product is "
        "then a matrix of rank one plus rounding, and its third exponent is the rounding floor "
        "lambda1 - ln(1/2.2e-16)/T (dashed in the plot): {:.4f} from this start, compared with "
        "{:.4f} by raw_product and {:.4f} by qr.",
        y, range / qr[0], rounded_from(qr, 2), rounded_from(qr, 1), rounding_floor(raw[0], T),
        raw[2], qr[2]));
}

void constancy(Report& report, const std::vector<PaperRun>& neighbours) {
    for (const int k : {0, 2}) {
        const Typical change = typical(neighbours, [k](const PaperRun& r) {
            return late_change(r.product().raw_product_history(), k);
        });
        Result found = result_of(change, 2);
        if (k > 0) {
            const TransferProduct& product = neighbours[0].product();
            const Exponents raw = product.raw_product();
            const double T = product.end_tau() - product.start_tau();
            found.words += fmt::format(
                "; at constant lambda1 the rounding floor changes by {:.2f}",
                (rounding_floor(raw[0], T) - rounding_floor(raw[0], T / 2)) / raw[k]);
        }
        report.add(
            {"Fig. 5",
             fmt::format(
                 "lambda{} as in the paper (raw_product), second half of the window: its range "
                 "without spikes over its last value",
                 k + 1),
             "almost constant", k == 0 ? "" : rounding_cause},
            found, almost_constant, k == 0 ? partly : not_reproduced);
    }
}

/// "It will not influence the ultimate goal" that the window begins at the first impact.
void starting_time(Report& report, const PaperRun& r) {
    constexpr double later = 100;
    const Analysis run = analyse(
        {.parameters = r.parameters,
         .start = default_state(r.parameters),
         .tau_end = window_end,
         .window = {later, window_end},
         .parts = {.exponents = true},
         .estimators = qr_alone});
    const double first = r.product().qr()[0], second = run.exponents->product.qr()[0],
                 change = std::abs(second - first) / r.run.exponents->growth.standard_error[0];
    report.add(
        {"Section 3",
         fmt::format(
             "b = 22 mm: lambda1 (qr) from tau = {:g} instead of from the first impact: change "
             "over its standard error",
             later),
         "the starting time \"will not influence the ultimate goal\""},
        {change, "{:.2f}: {:.4f}, {:.4f} from the first impact", change, second, first},
        {{0, 1}, "less than the uncertainty of the exponent"});
}

/// Spike of lambda1 by (33) at an impact. `depth`: distance below the mean of the neighbouring
/// entries, times the time since the first impact: the logarithm of an eigenvalue ratio. `rank`:
/// fraction of all impacts that are slower.
struct Spike {
    double depth, rank;
};

std::vector<Spike> spikes_of(const PaperRun& r) {
    const ExponentHistory& h = r.product().eigenvalues_history();
    std::vector<double> speeds;
    for (const Impact& i : r.run.impacts) speeds.push_back(std::abs(i.relative_speed_before));
    std::vector<Spike> spikes;
    for (std::size_t i = 10; i + 1 < h.tau.size(); ++i) {  // the first products are short
        const double neighbours_mean = (h.lambda[i - 1][0] + h.lambda[i + 1][0]) / 2,
                     depth =
                         (neighbours_mean - h.lambda[i][0]) * (h.tau[i] - r.product().start_tau());
        // The product's first entry is that of the second impact.
        const auto is_slower = [speed = speeds[i + 1]](double s) { return s < speed; };
        if (std::isfinite(depth)) spikes.push_back({depth, fraction(speeds, is_slower)});
    }
    std::ranges::sort(spikes, std::ranges::greater{}, &Spike::depth);
    return spikes;
}

constexpr std::size_t deepest = 8;

void spikes(Report& report, const PaperRun& r) {
    const std::vector<Spike> spikes = spikes_of(r);
    std::vector<double> ranks;
    for (std::size_t i = 0; i < deepest; ++i) ranks.push_back(spikes[i].rank);
    const double smallest = elementary::exp(-spikes[0].depth),
                 largest = elementary::exp(-spikes[deepest - 1].depth);
    report.add(
        {"Fig. 5",
         fmt::format(
             "the {} deepest spikes of lambda1, by (33): the eigenvalue over those at the "
             "neighbouring impacts",
             deepest),
         "\"u_i is equal or close to zero\""},
        {largest, "{:.0e} to {:.0e}", smallest, largest},
        {{0, 0.1},
         "a tenth or less: close to zero compared with its neighbours, since the product grows"});
    report.paragraph(fmt::format(
        "The paper says that the impacts of these spikes \"are probably related to the grazing "
        "bifurcation but cannot be justified with evidence here\". Here a fraction of {:.2f} of "
        "all impacts is slower, and therefore nearer to grazing, than theirs (median; {:.2f} to "
        "{:.2f}); by chance it would be .5. A spike occurs where the product's leading eigenvalue "
        "is small compared with the product: its right and left eigenvectors are nearly orthogonal "
        "there, which does not affect QR.",
        median(ranks), std::ranges::min(ranks), std::ranges::max(ranks)));
}

}  // namespace

void transient_exponents(Report& report, RunCache& runs) {
    const BothRuns both = runs.both(0.022);
    const auto [y, beside] = run_without_sticking(both.here.parameters);
    const TransferProduct &product = beside.product(), &other = both.by_equation.product();
    const std::string from =
        fmt::format("from y(0) = {:.8f} m with {} sticking phases", y, sticking_phases(beside));
    report.heading("Fig. 5: transient Lyapunov exponents, b = 22 mm");
    std::vector<Plot> histories = exponent_histories(both.here.product());
    histories.push_back(exponent_histories(product)[1]);
    histories[2].y_label = "qr, other start";
    report.picture(
        "fig5",
        "Fig. 5: above, eq. (33) from the unscaled product as in the paper; below, by QR, from the "
        "paper's start and " +
            from,
        histories, 230);
    positive_exponents(
        report,
        {"Fig. 5", "chaotic", "four exponents, positive",
         fmt::format(
             ", with {} sticking phases; {} {}: {}", sticking_phases(both.here), from,
             positive(product.qr()), in_words(product.qr()))},
        both);
    report.add(
        {"Fig. 5", "sum of the exponents (qr), from a start without a sticking phase",
         "positive, if all four are", rounding_cause},
        {sum_of(product.qr()), sum_of(other.qr()),
         "{:.4f} {}: -2 zeta + 2 z_T ln R to {:.0e}, z_T impacts per unit of tau; by eq. (1) "
         "{:.4f}",
         sum_of(product.qr()), from, product.sum_rule_residual(), sum_of(other.qr())},
        {{0, infinity}, "positive"}, not_reproduced);
    limits_of_the_computer(report, y, product);
    starting_time(report, both.here);
    constancy(report, runs.neighbours(0.022));
    spikes(report, both.here);
}

namespace {

/// Distances of the printed lambda1 from the mean, in standard deviations of a window of their
/// lengths: that of a time average falls with the root of the time.
std::vector<double> deviations(const Ensemble& e) {
    std::vector<double> all;
    for (const Table2Row& row : printed_table_2)
        all.push_back(e.lambda(0).deviations_of(row.lambda1) * std::sqrt(row.T() / window_tau));
    return all;
}

/// Sum of the deviations, in standard deviations of the sum.
double joint_deviation(const Ensemble& e) {
    const std::vector<double> each = deviations(e);
    return std::accumulate(each.begin(), each.end(), 0.) / std::sqrt(each.size());
}

void lambda1(Report& report, const BothEnsembles& windows) {
    const Moments here = windows.here.lambda(0), other = windows.by_equation.lambda(0);
    const double joint = joint_deviation(windows.here),
                 other_joint = joint_deviation(windows.by_equation);
    const std::vector<double> each = deviations(windows.here);
    report.add(
        {"Table 2", "lambda1 of the three windows together: sd above the mean of many",
         ".1093, .1143, .1197"},
        {joint, other_joint,
         "{} over {} windows of 1690; {:.1f} sd each (of windows of the same length), {:.1f} "
         "together, sum of squares {:.1f}; eq. (1): {:.3f}, {:.0f} together",
         here.in_words(4), windows.here.windows.size(), fmt::join(each, ", "), joint,
         sum_of_squares(each), other.mean, other_joint},
        {{-1.96, 1.96},
         "chance exceeds it once in 20 times; in part: once in 1000. All three lie on "
         "one side, which the sum of their squares (.115 to 11.3) would not show",
         Band{-3.29, 3.29}},
        partly_by_closed_form);
    report.add(
        {"Table 2", "lambda1 of many windows: sd over mean", "\"vary a little\""},
        {here.scatter(), other.scatter(), "{:.3f}", here.scatter()},
        {{0, 0.05}, "a twentieth, like the printed values (.045); in part: a fifth", Band{0, 0.2}},
        partly);
}

void lambda3(Report& report, const Ensemble& e) {
    const Moments here = e.lambda(2);
    report.add(
        {"Table 2", "lambda3 (qr)", ".08427, .09242, .1015", rounding_cause},
        {here.mean, here.in_words(3)}, {{0, infinity}, "positive, as printed"}, not_reproduced);
    std::vector<double> spreads;
    for (const Ensemble::Window& w : e.windows)
        if (!std::isnan(w.raw_spread)) spreads.push_back(w.raw_spread);
    // Nine in ten values of a normal distribution lie within 1.645 deviations.
    const double middle = median(spreads), low = quantile(spreads, 0.05),
                 high = quantile(spreads, 0.95), deviation = (high - low) / (2 * 1.645);
    std::vector<double> off;
    for (const Table2Row& row : printed_table_2) off.push_back((row.spread() - middle) / deviation);
    const double squares = sum_of_squares(off);
    report.add(
        {"Table 2",
         "(lambda1 - lambda3) T of the three windows together, by raw_product: sum of "
         "squared deviations from the median in sd",
         "42.3, 42.5, 34.0"},
        {squares,
         "{:.1f}; {} windows: median {:.1f}, nine in ten from {:.1f} to {:.1f}: sd {:.1f}; by "
         "qr {:.0f}",
         squares, spreads.size(), middle, low, high, deviation,
         (e.lambda(0).mean - here.mean) * window_tau},
        {{0, 7.8},
         "chance exceeds it once in 20 times (chi squared with three degrees of "
         "freedom); in part: once in 1000. The sd is that of the middle nine tenths: "
         "rounding has no upper limit (spikes)",
         Band{0, 16.3}},
        partly);
    report.paragraph(
        "If the printed lambda3 is rounding, it lies about ln(1/2.2e-16)/T = 36.0/T below lambda1, "
        "as by raw_product; if it is the exponent, as by qr.");
}

}  // namespace

void table_2(Report& report, RunCache& runs) {
    report.heading("Table 2: other windows, b = 22 mm");
    const BothEnsembles windows = runs.both_ensembles(0.022, WindowsOf::tau_1690);
    lambda1(report, windows);
    lambda3(report, windows.here);
}

}  // namespace vines::report
