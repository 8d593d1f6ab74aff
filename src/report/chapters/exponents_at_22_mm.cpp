// Exponents at b = 22 mm.
//
// Fig. 5: the transient Lyapunov exponents. The paper finds all four positive, and attributes their
// spikes to grazing. But the exponents' sum is negative by the sum rule (lyapunov.hpp), and the
// spikes of lambda1 are zero crossings of the product's leading eigenvalue.
//
// Table 2: the exponents over three windows of one run. After a few hundred units of tau a chaotic
// run is one of many possible ones, so the three printed numbers together are compared with their
// distribution over many windows of several runs.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/elementary.hpp"
#include "report/exponent_claims.hpp"
#include "report/plots.hpp"
#include "report/report.hpp"
#include "report/runs.hpp"
#include "report/statistics.hpp"

namespace vines::report {

namespace {

double sum_of(const Exponents& l) { return l[0] + l[1] + l[2] + l[3]; }

void their_sum(Report& report, const TransferProduct& product, const TransferProduct& other) {
    const double sum = sum_of(product.qr());
    report.add(
        {.where = "Fig. 5",
         .what = "sum of the exponents (qr)",
         .paper = "positive, if all four are",
         .here = fmt::format(
             "{:.4f}; -2 zeta + 2 z_T ln R to {:.0e}, z_T impacts per unit of tau", sum,
             product.sum_rule_residual()),
         .number = sum,
         .by_equation = sum_of(other.qr()),
         .band = {0, infinity},
         .because = "positive",
         .expected = ClaimVerdict::not_reproduced});
}

/// Window length from which on the product in double precision has lost the k-th exponent.
double rounded_from(const Exponents& qr, int k) {
    return -elementary::log(std::numeric_limits<double>::epsilon()) / (qr[0] - qr[k]);
}

/// Limits of a product in double precision: what it retains of the exponents, and for how long.
void limits_of_the_computer(Report& report, const TransferProduct& product) {
    const Exponents qr = product.qr(), raw = product.raw_product();
    const double T = product.end_tau() - product.start_tau(),
                 range = elementary::log(std::numeric_limits<double>::max());
    report.paragraph(fmt::format(
        "The exponents add up to -2 zeta + (2/T) (sum of ln R), for any motion: they cannot all be "
        "positive. \"Too large value of transfer matrix M in Eq. (32) will exceed the capability "
        "of computer\": at this lambda1 its entries overflow at T = {:.0f}; but rounding hides "
        "lambda3 from T = {:.0f} on, and lambda2 from {:.0f} on. The unscaled product is then a "
        "matrix of rank one plus rounding, and its third exponent is the rounding floor lambda1 - "
        "ln(1/2.2e-16)/T, the dashed line: {:.4f} here, compared with {:.4f} by raw_product and "
        "{:.4f} by qr.",
        range / qr[0], rounded_from(qr, 2), rounded_from(qr, 1), rounding_floor(raw[0], T), raw[2],
        qr[2]));
}

void constancy(Report& report, const std::vector<PaperRun>& neighbours) {
    for (const int k : {0, 2}) {
        const Typical change = typical(neighbours, [k](const PaperRun& r) {
            return late_change(r.run.exponents->product.raw_product_history(), k);
        });
        report.add(
            {.where = "Fig. 5",
             .what = fmt::format(
                 "lambda{} as in the paper (raw_product), second half of the window: its range "
                 "without spikes over its last value",
                 k + 1),
             .paper = "almost constant",
             .here = change.in_words(2),
             .number = change.median,
             .band = {0, small_change},
             .because = why_small_change,
             .partly = Band{0, some_change},
             .expected = k == 0 ? ClaimVerdict::partly : ClaimVerdict::not_reproduced});
    }
}

/// Spike of the k-th exponent at an impact. `T`: time since the first impact. `depth`: distance
/// below the mean of the neighbouring entries, times T, that is the logarithm of an eigenvalue
/// ratio. `rank`: fraction of all impacts that are slower.
struct Spike {
    double T, depth, rank;
};

std::vector<Spike> spikes_of(const PaperRun& r, const ExponentHistory& h, int k) {
    const double start = r.run.exponents->product.start_tau();
    std::vector<double> speeds;
    for (const Impact& i : r.run.impacts) speeds.push_back(std::abs(i.relative_speed_before));
    const auto share_slower_than = [&](double speed) {
        return static_cast<double>(
                   std::ranges::count_if(speeds, [&](double s) { return s < speed; })) /
               static_cast<double>(speeds.size());
    };
    std::vector<Spike> spikes;
    for (std::size_t i = 10; i + 1 < h.tau.size(); ++i) {  // the first products are short
        const double neighbours_mean = (h.lambda[i - 1][k] + h.lambda[i + 1][k]) / 2,
                     T = h.tau[i] - start, depth = (neighbours_mean - h.lambda[i][k]) * T;
        // The product's first entry is that of the second impact.
        if (std::isfinite(depth)) spikes.push_back({T, depth, share_slower_than(speeds[i + 1])});
    }
    std::ranges::sort(spikes, std::ranges::greater{}, &Spike::depth);
    return spikes;
}

constexpr std::size_t deepest = 8;

void spikes(Report& report, const PaperRun& r, const TransferProduct& product) {
    const std::vector<Spike> spikes = spikes_of(r, product.eigenvalues_history(), 0);
    std::vector<double> ranks;
    for (std::size_t i = 0; i < deepest; ++i) ranks.push_back(spikes[i].rank);
    const double smallest = elementary::exp(-spikes[0].depth),
                 largest = elementary::exp(-spikes[deepest - 1].depth);
    report.add(
        {.where = "Fig. 5",
         .what = fmt::format(
             "the {} deepest spikes of lambda1, by (33): the eigenvalue over those at the "
             "neighbouring impacts",
             deepest),
         .paper = "\"u_i is equal or close to zero\"",
         .here = fmt::format("{:.0e} to {:.0e}", smallest, largest),
         .number = largest,
         .band = {0, 0.1},
         .because = "a tenth or less: close to zero compared with its neighbours, since the "
                    "product grows"});
    report.paragraph(fmt::format(
        "The paper says that the impacts of these spikes \"are probably related to the grazing "
        "bifurcation but cannot be justified with evidence here\". Here a fraction of {:.2f} of "
        "all impacts is slower, and therefore nearer to grazing, than theirs (median; {:.2f} to "
        "{:.2f}); by chance it would be .5.",
        median(ranks), std::ranges::min(ranks), std::ranges::max(ranks)));
}

}  // namespace

void transient_exponents(Report& report, RunCache& runs) {
    const PaperRun &r = runs.paper_run(0.022),
                   &by_equation = runs.paper_run(0.022, Damping::equation_of_motion);
    const TransferProduct& product = r.run.exponents->product;
    report.heading("Fig. 5: transient Lyapunov exponents, b = 22 mm");
    report.picture(
        {.name = "fig5",
         .caption = "Fig. 5: above, eq. (33) from the unscaled product as in the paper; below, by "
                    "QR",
         .plots = exponent_histories(product),
         .height = 230});
    positive_exponents(
        report, {.where = "Fig. 5", .chaotic = "chaotic", .positive = "four exponents, positive"},
        r, by_equation);
    their_sum(report, product, by_equation.run.exponents->product);
    limits_of_the_computer(report, product);
    constancy(report, runs.neighbours(0.022));
    spikes(report, r, product);
    const double rounded = rounded_from(product.qr(), 3);
    const std::vector<Spike> of_lambda4 = spikes_of(r, product.raw_product_history(), 3);
    const auto in_rounding = std::ranges::count_if(
        of_lambda4.begin(), of_lambda4.begin() + deepest,
        [rounded](const Spike& s) { return s.T > rounded; });
    report.paragraph(fmt::format(
        "A spike of lambda1 by (33) occurs where the product's leading eigenvalue is small "
        "compared with the product: its right and left eigenvectors are nearly orthogonal there, "
        "which does not affect QR. Of the {} deepest spikes of lambda4 by raw_product, {} occur "
        "after T = {:.0f}, where lambda4 is rounding only.",
        deepest, in_rounding, rounded));
}

namespace {

/// Distance of a printed lambda1 from the mean, in standard deviations of a window of its length.
double deviations(const Table2Row& row, const Ensemble& e) {
    // The standard deviation of a time average falls with the root of the time.
    return e.lambda(0).deviations_of(row.lambda1) * std::sqrt(row.T() / window_tau);
}

/// Sum of the three deviations, in standard deviations of the sum.
double joint_deviation(const Ensemble& e) {
    double sum = 0;
    for (const Table2Row& row : printed_table_2) sum += deviations(row, e);
    return sum / std::sqrt(std::size(printed_table_2));
}

void lambda1(Report& report, const Ensemble& closed_form, const Ensemble& by_equation) {
    const Moments here = closed_form.lambda(0), other = by_equation.lambda(0);
    const double joint = joint_deviation(closed_form), other_joint = joint_deviation(by_equation);
    std::string each;
    double squares = 0;
    for (const Table2Row& row : printed_table_2) {
        const double off = deviations(row, closed_form);
        squares += off * off;
        each += fmt::format("{}{:.1f}", each.empty() ? "" : ", ", off);
    }
    report.add(
        {.where = "Table 2",
         .what = "lambda1 of the three windows together: sd above the mean of many",
         .paper = ".1093, .1143, .1197",
         .here = fmt::format(
             "{:.4f} +- {:.4f} over {} windows of 1690; {} sd each (of windows of the same "
             "length), {:.1f} together, sum of squares {:.1f}; eq. (1): {:.3f}, {:.0f} together",
             here.mean, here.deviation, closed_form.windows.size(), each, joint, squares,
             other.mean, other_joint),
         .number = joint,
         .by_equation = other_joint,
         .band = {-1.96, 1.96},
         .because = "chance exceeds it once in 20 times; in part: once in 1000. All three lie on "
                    "one side, which the sum of their squares (.115 to 11.3) would not show",
         .partly = Band{-3.29, 3.29},
         .expected = ClaimVerdict::partly_by_closed_form});
    report.add(
        {.where = "Table 2",
         .what = "lambda1 of many windows: sd over mean",
         .paper = "\"vary a little\"",
         .here = fmt::format("{:.3f}", here.scatter()),
         .number = here.scatter(),
         .by_equation = other.scatter(),
         .band = {0, 0.05},
         .because = "a twentieth, like the printed values (.045); in part: a fifth",
         .partly = Band{0, some_change},
         .expected = ClaimVerdict::partly});
}

void lambda3(Report& report, const Ensemble& e) {
    const Moments here = e.lambda(2), raw = e.raw_spread();
    report.add(
        {.where = "Table 2",
         .what = "lambda3 (qr)",
         .paper = ".08427, .09242, .1015",
         .here = fmt::format("{:.3f} +- {:.3f}", here.mean, here.deviation),
         .number = here.mean,
         .band = {0, infinity},
         .because = "positive, as printed",
         .expected = ClaimVerdict::not_reproduced});
    std::vector<double> spreads;
    for (const Ensemble::Window& w : e.windows)
        if (!std::isnan(w.raw_spread)) spreads.push_back(w.raw_spread);
    // Nine in ten values of a normal distribution lie within 1.645 deviations.
    const double middle = median(spreads), low = quantile(spreads, 0.05),
                 high = quantile(spreads, 0.95), deviation = (high - low) / (2 * 1.645);
    double squares = 0;
    for (const Table2Row& row : printed_table_2)
        squares += std::pow((row.spread() - middle) / deviation, 2);
    report.add(
        {.where = "Table 2",
         .what = "(lambda1 - lambda3) T of the three windows together, by raw_product: sum of "
                 "squared deviations from the median in sd",
         .paper = "42.3, 42.5, 34.0",
         .here = fmt::format(
             "{:.1f}; {} windows: median {:.1f}, nine in ten from {:.1f} to {:.1f}: sd {:.1f}",
             squares, spreads.size(), middle, low, high, deviation),
         .number = squares,
         .band = {0, 7.8},
         .because = "chance exceeds it once in 20 times (chi squared with three degrees of "
                    "freedom); in part: once in 1000. The sd is that of the middle nine tenths: "
                    "rounding has no upper limit (spikes)",
         .partly = Band{0, 16.3},
         .expected = ClaimVerdict::partly});
    DataTable table{
        {"window", "printed lambda3", "printed (lambda1 - lambda3) T", "raw_product", "qr"}, {}};
    for (const Table2Row& row : printed_table_2) {
        const double exact = (e.lambda(0).mean - here.mean) * row.T();
        table.rows.push_back(
            {fmt::format("[{:g}, {:g}]", row.from, row.to), fmt::format("{:g}", row.lambda3),
             fmt::format("{:.1f}", row.spread()),
             fmt::format("{:.1f} +- {:.1f}", raw.mean, raw.deviation),
             fmt::format("{:.0f}", exact)});
    }
    report.paragraph(
        "If the printed lambda3 is rounding, it lies about ln(1/2.2e-16)/T = 36.0/T below lambda1, "
        "as by raw_product; if it is the exponent, as by qr.");
    report.table(table);
}

}  // namespace

void table_2(Report& report, RunCache& runs) {
    report.heading("Table 2: other windows, b = 22 mm");
    const Ensemble &closed_form = runs.ensemble(0.022, WindowsOf::tau_1690),
                   &by_equation =
                       runs.ensemble(0.022, WindowsOf::tau_1690, Damping::equation_of_motion);
    lambda1(report, closed_form, by_equation);
    lambda3(report, closed_form);
}

}  // namespace vines::report
