// Fig. 5: the transient Lyapunov exponents at b = 22 mm. The paper finds all four positive, and
// spikes of which it supposes that they come of grazing. The exponents' sum is negative by the sum
// rule (lyapunov.hpp), and the spikes of lambda1 are the leading eigenvalue of the product as it
// passes through zero.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/chapters.hpp"
#include "report/exponent_claims.hpp"
#include "report/plots.hpp"

#include "core/motion/elementary.hpp"
#include "core/motion/special_values.hpp"

namespace vines::report {

namespace {

double sum_of(const Exponents& l) { return l[0] + l[1] + l[2] + l[3]; }

void their_sum(Report& report, const TransferProduct& product, const TransferProduct& other) {
    const double sum = sum_of(product.qr());
    report.find(
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
         .expected = Verdict::not_reproduced});
}

/// From this length of the window on, the product in double precision holds nothing of the k-th
/// exponent.
double rounded_from(const Exponents& qr, int k) {
    return -elementary::log(std::numeric_limits<double>::epsilon()) / (qr[0] - qr[k]);
}

/// What a product in double precision can hold of the exponents, and until when.
void limits_of_the_computer(Report& report, const TransferProduct& product) {
    const Exponents qr = product.qr(), raw = product.raw_product();
    const double T = product.end_tau() - product.start_tau(),
                 range = elementary::log(std::numeric_limits<double>::max());
    report.say(fmt::format(
        "The exponents add up to -2 zeta + (2/T) (sum of ln R), whatever the motion: they cannot "
        "all be positive. \"Too large value of transfer matrix M in Eq. (32) will exceed the "
        "capability of computer\": at this lambda1 its entries overflow at T = {:.0f}; but from T "
        "= {:.0f} on rounding hides lambda3, from {:.0f} on lambda2. The unscaled product is then "
        "a matrix of rank one plus rounding, and what stands for the third exponent is the floor "
        "lambda1 - ln(1/2.2e-16)/T, the broken line: {:.4f} here, where raw_product has {:.4f} and "
        "qr {:.4f}.",
        range / qr[0], rounded_from(qr, 2), rounded_from(qr, 1), rounding_floor(raw[0], T), raw[2],
        qr[2]));
}

void constancy(Report& report, const std::vector<Response>& neighbours) {
    for (const int k : {0, 2}) {
        const Typical change = typical(neighbours, [k](const Response& r) {
            return late_change(r.run.exponents->product.raw_product_history(), k);
        });
        report.find(
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
             .expected = k == 0 ? Verdict::partly : Verdict::not_reproduced});
    }
}

/// One impact, T after the first: how far the k-th exponent lies below the mean of those at its
/// neighbours, times T, which makes it the logarithm of an eigenvalue; and which share of all
/// impacts is slower.
struct Spike {
    double T, depth, rank;
};

/// The deepest first.
std::vector<Spike> spikes_of(const Response& r, const ExponentHistory& h, int k) {
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
        const double beside = (h.lambda[i - 1][k] + h.lambda[i + 1][k]) / 2, T = h.tau[i] - start,
                     depth = (beside - h.lambda[i][k]) * T;
        // The product's first entry is that of the second impact.
        if (std::isfinite(depth)) spikes.push_back({T, depth, share_slower_than(speeds[i + 1])});
    }
    std::ranges::sort(spikes, std::ranges::greater{}, &Spike::depth);
    return spikes;
}

constexpr std::size_t deepest = 8;

void spikes(Report& report, const Response& r, const TransferProduct& product) {
    const std::vector<Spike> spikes = spikes_of(r, product.eigenvalues_history(), 0);
    std::vector<double> ranks;
    for (std::size_t i = 0; i < deepest; ++i) ranks.push_back(spikes[i].rank);
    const double smallest = elementary::exp(-spikes[0].depth),
                 largest = elementary::exp(-spikes[deepest - 1].depth);
    report.find(
        {.where = "Fig. 5",
         .what = fmt::format(
             "the {} deepest spikes of lambda1, by (33): the eigenvalue over those at the impacts "
             "beside",
             deepest),
         .paper = "\"u_i is equal or close to zero\"",
         .here = fmt::format("{:.0e} to {:.0e}", smallest, largest),
         .number = largest,
         .band = {0, 0.1},
         .because = "a tenth or less: close to zero beside its neighbours, as the product grows"});
    report.say(fmt::format(
        "Of these spikes the paper says that their impacts \"are probably related to the grazing "
        "bifurcation but cannot be justified with evidence here\". Here {:.2f} of all impacts are "
        "slower, and so nearer to grazing, than theirs (the median; {:.2f} to {:.2f}); by chance "
        "it would be .5.",
        median(ranks), std::ranges::min(ranks), std::ranges::max(ranks)));
}

}  // namespace

void transient_exponents(Report& report, Runs& runs) {
    const Response &r = runs.response(0.022),
                   &by_equation = runs.response(0.022, Damping::equation_of_motion);
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
    report.say(fmt::format(
        "A spike of lambda1 by (33) is where the product's leading eigenvalue is small beside the "
        "product: its right and its left direction are nearly orthogonal there, which QR never "
        "sees. Of the {} deepest spikes of lambda4 by raw_product {} come later than T = {:.0f}, "
        "where it is rounding alone.",
        deepest, in_rounding, rounded));
}

}  // namespace vines::report
