// Fig. 5: the transient Lyapunov exponents at b = 22 mm. The paper finds all four positive, and
// spikes that it puts down to grazing. Their sum is negative by the sum rule (lyapunov.hpp), and
// the spikes are the leading eigenvalue of the product as it passes through zero.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/chapters.hpp"
#include "report/plots.hpp"

namespace vines::report {

namespace {

void how_many_are_positive(Report& report, const TransferProduct& product) {
    const long raw = positive(product.raw_product()), qr = positive(product.qr());
    report.find(
        {.where = "Fig. 5",
         .what = "positive exponents, as the paper computed",
         .paper = "4",
         .here = fmt::format("{} (raw_product)", raw),
         .verdict = not_reproduced("rounding"),
         .number = static_cast<double>(raw),
         .band = exactly(4)});
    report.find(
        {.where = "Fig. 5",
         .what = "positive exponents",
         .paper = "4",
         .here = fmt::format("{} (qr)", qr),
         .verdict = not_reproduced("their sum is negative"),
         .number = static_cast<double>(qr),
         .band = exactly(1)});
}

void their_sum(Report& report, const TransferProduct& product) {
    const Exponents qr = product.qr();
    report.find(
        {.where = "Fig. 5",
         .what = "sum of the exponents",
         .paper = "positive",
         .here = fmt::format(
             "{:.4f}, the sum rule to {:.0e}", qr[0] + qr[1] + qr[2] + qr[3],
             product.sum_rule_residual()),
         .verdict = not_reproduced("the sum is -2 zeta + 2 z_T ln R"),
         .number = product.sum_rule_residual(),
         .band = {0, 1e-11}});
    report.say(
        "The exponents add up to -2 zeta + (2/T) (sum of ln R), whatever the motion: they cannot "
        "all be positive. The unscaled product of transfer matrices becomes a matrix of rank one "
        "plus rounding, and what is printed as lambda3 is lambda1 - ln(1/2.2e-16)/T, the broken "
        "line. See it yourself: "
        "`curl -s 127.0.0.1:8080/v1/simulate -d "
        "'{\"preset\":\"fig5\",\"include\":[\"exponents\"]}' | jq '.exponents.raw_product.final, "
        ".exponents.raw_product.rounding_floor, .exponents.qr.final'`.");
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

void spikes(Report& report, const Response& r) {
    constexpr std::ptrdiff_t most = 8;
    std::vector<Dip> dips = dips_of(r);
    std::ranges::sort(dips, {}, &Dip::depth);
    const double slowest_at_spike =
        std::min_element(dips.begin(), dips.begin() + most, [](const Dip& a, const Dip& b) {
            return a.speed < b.speed;
        })->speed;
    std::ranges::sort(dips, {}, &Dip::speed);
    report.find(
        {.where = "Fig. 5",
         .what = "relative speed (over its median) at the 8 deepest spikes",
         .paper = "spikes probably related to grazing",
         .here = fmt::format(
             "{:.2f} at least; the 8 impacts nearest to grazing (below {:.2f}) have none",
             slowest_at_spike, dips[most - 1].speed),
         .verdict = not_reproduced("the spikes are not grazing"),
         .number = slowest_at_spike,
         .band = {0.3, 10}});
    report.say(
        "The spikes come at ordinary impacts: the leading eigenvalue of the product passes through "
        "zero where its right and its left direction are orthogonal, which QR never sees. "
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
    how_many_are_positive(report, product);
    their_sum(report, product);
    spikes(report, r);
}

}  // namespace vines::report
