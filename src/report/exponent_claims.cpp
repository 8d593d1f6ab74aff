#include "report/exponent_claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/motion/elementary.hpp"
#include "report/statistics.hpp"

namespace vines::report {

std::string in_words(const Exponents& lambda) {
    return fmt::format(
        "{:.4f}, {:.4f}, {:.4f}, {:.4f}", lambda[0], lambda[1], lambda[2], lambda[3]);
}

Exponents exponents_of(const PaperRun& r) {
    const auto& orbit = r.run.regime->orbit;
    return orbit ? orbit->exponents(r.parameters) : r.run.exponents->product.qr();
}

namespace {

std::span<const Exponents> late(const ExponentHistory& h) {
    const double half = (h.tau.front() + h.tau.back()) / 2;
    const auto first = std::ranges::lower_bound(h.tau, half) - h.tau.begin();
    return std::span(h.lambda).subspan(static_cast<std::size_t>(first));
}

/// Fractions of the impacts in the second half of a window. `share`: of the impacts without a zero
/// eigenvalue, those at which all four exponents are positive. `spikes`: of all impacts, those with
/// a zero eigenvalue (the paper: "transient spikes", "at these non-smooth points u_i is equal or
/// close to zero").
struct Positive {
    double share, spikes;
};
Positive all_positive(const ExponentHistory& h) {
    double all = 0, finite = 0;
    for (const Exponents& lambda : late(h)) {
        if (!std::ranges::all_of(lambda, [](double l) { return std::isfinite(l); })) continue;
        ++finite;
        all += positive(lambda) == 4;
    }
    return {all / finite, 1 - finite / static_cast<double>(late(h).size())};
}

double over_error(const PaperRun& r) {
    const auto& exponents = *r.run.exponents;
    return exponents.product.qr()[0] / exponents.growth.standard_error[0];
}

void chaotic(
    Report& report, const PositiveExponents& paper, const PaperRun& here, const PaperRun& other) {
    const auto text = [](const PaperRun& r) {
        const auto& exponents = *r.run.exponents;
        return fmt::format(
            "{:.4f} +- {:.4f}", exponents.product.qr()[0], exponents.growth.standard_error[0]);
    };
    report.add(
        {.where = paper.where,
         .what = "lambda1 (qr) over its standard error",
         .paper = paper.chaotic,
         .here = fmt::format("{}; by eq. (1) {}", text(here), text(other)),
         .number = over_error(here),
         .by_equation = over_error(other),
         .band = {3, infinity},
         .because = "positive by three standard errors"});
}

}  // namespace

void positive_exponents(
    Report& report, const PositiveExponents& paper, const PaperRun& here, const PaperRun& other) {
    chaotic(report, paper, here, other);
    const TransferProduct &product = here.run.exponents->product,
                          &by_equation = other.run.exponents->product;
    const Positive found = all_positive(product.raw_product_history());
    report.add(
        {.where = paper.where,
         .what = "raw_product, second half of the window without its spikes: fraction of impacts "
                 "up to which all four are positive",
         .paper = paper.positive,
         .here = fmt::format(
             "{:.2f}; at the last {}. At {:.2f} of all impacts an eigenvalue is zero: a spike",
             found.share, in_words(product.raw_product()), found.spikes),
         .number = found.share,
         .by_equation = all_positive(by_equation.raw_product_history()).share,
         .band = {0.9, 1},
         .because = "nine in ten; spikes, which the paper mentions too, are left out"});
    const Exponents lambda = product.qr();
    report.add(
        {.where = paper.where,
         .what = "positive exponents (qr)",
         .paper = paper.positive,
         .here = fmt::format("{}: {}", positive(lambda), in_words(lambda)),
         .number = static_cast<double>(positive(lambda)),
         .by_equation = static_cast<double>(positive(by_equation.qr())),
         .band = exactly(4),
         .because = "all four",
         .expected = ClaimVerdict::not_reproduced});
}

double late_change(const ExponentHistory& h, int k) {
    std::vector<double> values;
    for (const Exponents& lambda : late(h))
        if (std::isfinite(lambda[k])) values.push_back(lambda[k]);
    const double last = values.back();
    return (quantile(values, 0.95) - quantile(values, 0.05)) / std::abs(last);
}

}  // namespace vines::report
