// Fig. 5: the transient Lyapunov exponents at b = 22 mm. The paper finds all four positive, and
// spikes that it puts down to grazing. Their sum is negative by the sum rule (lyapunov.hpp), and
// the spikes are the leading eigenvalue of the product as it passes through zero.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/chapters.hpp"
#include "report/exponent_claims.hpp"
#include "report/plots.hpp"

#include "core/motion/special_values.hpp"

namespace vines::report {

namespace {

void their_sum(Report& report, const TransferProduct& product) {
    const Exponents qr = product.qr(), raw = product.raw_product();
    const double sum = qr[0] + qr[1] + qr[2] + qr[3], T = product.end_tau() - product.start_tau();
    report.find(
        {.where = "Fig. 5",
         .what = "sum of the exponents",
         .paper = "positive",
         .here = fmt::format(
             "{:.4f}; -2 zeta + 2 z_T ln R to {:.0e}", sum, product.sum_rule_residual()),
         .number = sum,
         .band = {0, infinity},
         .because = "four positive numbers",
         .expected = Verdict::not_reproduced});
    report.say(fmt::format(
        "The exponents add up to -2 zeta + (2/T) (sum of ln R), whatever the motion: they "
        "cannot all be positive. The unscaled product of transfer matrices becomes a matrix of "
        "rank one plus rounding, and what stands for the third exponent is the floor lambda1 - "
        "ln(1/2.2e-16)/T, the broken line: {:.4f} here, where raw_product has {:.4f} and qr "
        "{:.4f}. See it yourself: "
        "`curl -s 127.0.0.1:8080/v1/simulate -d "
        "'{{\"preset\":\"fig5\",\"include\":[\"exponents\"]}}' | jq "
        "'.exponents.raw_product.final, .exponents.raw_product.rounding_floor, "
        ".exponents.qr.final'`.",
        rounding_floor(raw[0], T), raw[2], qr[2]));
}

void constancy(Report& report, const TransferProduct& product) {
    const ExponentHistory& raw = product.raw_product_history();
    for (const int k : {0, 2}) {
        const double change = late_change(raw, k);
        report.find(
            {.where = "Fig. 5",
             .what = fmt::format(
                 "lambda{} as in the paper (raw_product), second half of the window: its range "
                 "without spikes over its last value",
                 k + 1),
             .paper = "almost constant",
             .here = fmt::format("{:.2f}", change),
             .number = change,
             .band = {0, small_change},
             .because = why_small_change,
             .partly = Band{0, some_change},
             .expected = Verdict::partly});
    }
}

/// One impact: how far the exact product's largest exponent then falls below that of QR, times T,
/// and its relative speed over the median.
struct Dip {
    double depth, speed;
};

std::vector<Dip> dips_of(const Response& r) {
    const TransferProduct& product = r.run.exponents->product;
    const ExponentHistory &exact = product.eigenvalues_history(), &qr = product.qr_history();
    std::vector<double> speeds;
    for (const Impact& i : r.run.impacts) speeds.push_back(std::abs(i.relative_speed_before));
    const double usual = median(speeds);
    std::vector<Dip> dips;
    for (std::size_t i = 10; i < exact.tau.size(); ++i)  // the first products are short
        dips.push_back(
            {(exact.lambda[i][0] - qr.lambda[i][0]) * (exact.tau[i] - product.start_tau()),
             speeds[i + 1] / usual});
    return dips;
}

/// Of the impacts at the deepest spikes and those nearest to grazing: how many are both.
long slow_spikes(std::vector<Dip> dips, std::ptrdiff_t most) {
    std::ranges::sort(dips, {}, &Dip::speed);
    const double slow = dips[most - 1].speed;
    std::ranges::sort(dips, {}, &Dip::depth);
    return std::count_if(
        dips.begin(), dips.begin() + most, [&](const Dip& d) { return d.speed <= slow; });
}

void spikes(Report& report, const Response& r) {
    constexpr std::ptrdiff_t most = 8;
    std::vector<Dip> dips = dips_of(r);
    const long both = slow_spikes(dips, most);
    std::ranges::sort(dips, {}, &Dip::depth);
    std::vector<double> speeds;
    for (std::ptrdiff_t i = 0; i < most; ++i) speeds.push_back(dips[i].speed);
    report.find(
        {.where = "Fig. 5",
         .what = "of the 8 deepest spikes, those at one of the 8 impacts nearest to grazing",
         .paper = "\"probably related to grazing\", a conjecture",
         .here = fmt::format(
             "{}; relative speeds at the spikes {:.2f} to {:.2f} of the median", both,
             std::ranges::min(speeds), std::ranges::max(speeds)),
         .number = static_cast<double>(both),
         .band = {4, 8},
         .because = "half of them or more",
         .partly = Band{2, 8},
         .expected = Verdict::not_reproduced});
    report.say(
        "A spike of eq. (33) is where the leading eigenvalue of the product passes through zero: "
        "its right and its left direction are orthogonal there, which QR never sees. "
        "`relative_speed_ratio` in the answer's impacts tells how near to grazing each one is.");
}

}  // namespace

void transient_exponents(Report& report, Runs& runs) {
    const Response& r = runs.response(0.022);
    const TransferProduct& product = r.run.exponents->product;
    report.heading("Fig. 5: transient Lyapunov exponents, b = 22 mm");
    report.picture(
        {.name = "fig5",
         .caption = "Fig. 5: above, eq. (33) from the unscaled product as in the paper; below, by "
                    "QR",
         .plots = exponent_histories(product),
         .height = 230});
    positive_exponents(report, "Fig. 5", r, Verdict::reproduced);
    their_sum(report, product);
    constancy(report, product);
    spikes(report, r);
}

}  // namespace vines::report
