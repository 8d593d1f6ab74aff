#include "report/exponent_claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "core/motion/special_values.hpp"
#include "report/statistics.hpp"

namespace vines::report {

std::string in_words(const Exponents& lambda) {
    return fmt::format(
        "{:.4f}, {:.4f}, {:.4f}, {:.4f}", lambda[0], lambda[1], lambda[2], lambda[3]);
}

namespace {

/// Of a history's values those of the second half of its window.
std::span<const Exponents> late(const ExponentHistory& h) {
    const double half = (h.tau.front() + h.tau.back()) / 2;
    const auto first = std::ranges::lower_bound(h.tau, half) - h.tau.begin();
    return std::span(h.lambda).subspan(static_cast<std::size_t>(first));
}

double share_all_positive(const ExponentHistory& h) {
    const auto all = std::ranges::count_if(
        late(h), [](const Exponents& lambda) { return positive(lambda) == 4; });
    return static_cast<double>(all) / static_cast<double>(late(h).size());
}

double over_error(const Response& r) {
    const auto& exponents = *r.run.exponents;
    return exponents.product.qr()[0] / exponents.growth.standard_error[0];
}

void chaotic(
    Report& report, const PositiveExponents& paper, const Response& here, const Response& other) {
    const auto text = [](const Response& r) {
        const auto& exponents = *r.run.exponents;
        return fmt::format(
            "{:.4f} +- {:.4f}", exponents.product.qr()[0], exponents.growth.standard_error[0]);
    };
    report.find(
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
    Report& report, const PositiveExponents& paper, const Response& here, const Response& other) {
    chaotic(report, paper, here, other);
    const TransferProduct &product = here.run.exponents->product,
                          &by_equation = other.run.exponents->product;
    const double share = share_all_positive(product.raw_product_history());
    report.find(
        {.where = paper.where,
         .what = "raw_product, second half of the window: share of impacts up to which all four "
                 "are positive",
         .paper = paper.positive,
         .here = fmt::format("{:.2f}; at the last {}", share, in_words(product.raw_product())),
         .number = share,
         .by_equation = share_all_positive(by_equation.raw_product_history()),
         .band = {0.9, 1},
         .because = "nine in ten; in part: more than half",
         .partly = Band{0.5, 1},
         .expected = Verdict::partly});
    const Exponents lambda = product.qr();
    report.find(
        {.where = paper.where,
         .what = "positive exponents (qr)",
         .paper = paper.positive,
         .here = fmt::format("{}: {}", positive(lambda), in_words(lambda)),
         .number = static_cast<double>(positive(lambda)),
         .by_equation = static_cast<double>(positive(by_equation.qr())),
         .band = exactly(4),
         .because = "all four",
         .expected = Verdict::not_reproduced});
}

double late_change(const ExponentHistory& h, int k) {
    std::vector<double> values;
    for (const Exponents& lambda : late(h))
        if (std::isfinite(lambda[k])) values.push_back(lambda[k]);
    const double last = values.back();
    return (quantile(values, 0.95) - quantile(values, 0.05)) / std::abs(last);
}

}  // namespace vines::report
