#include "report/exponent_claims.hpp"

#include <fmt/format.h>

#include <cmath>

#include "core/motion/special_values.hpp"
#include "report/statistics.hpp"

namespace vines::report {

std::string in_words(const Exponents& lambda) {
    return fmt::format(
        "{:.4f}, {:.4f}, {:.4f}, {:.4f}", lambda[0], lambda[1], lambda[2], lambda[3]);
}

namespace {

double share_all_positive(const ExponentHistory& h) {
    const double half = (h.tau.front() + h.tau.back()) / 2;
    double all = 0, impacts = 0;
    for (std::size_t i = 0; i < h.tau.size(); ++i)
        if (h.tau[i] >= half) all += positive(h.lambda[i]) == 4, ++impacts;
    return all / impacts;
}

double over_error(const Response& r) {
    const auto& exponents = *r.run.exponents;
    return exponents.product.qr()[0] / exponents.growth.standard_error[0];
}

void chaotic(
    Report& report, const std::string& where, const Response& here, const Response& other) {
    const auto text = [](const Response& r) {
        const auto& exponents = *r.run.exponents;
        return fmt::format(
            "{:.4f} +- {:.4f}", exponents.product.qr()[0], exponents.growth.standard_error[0]);
    };
    report.find(
        {.where = where,
         .what = "lambda1 (qr) over its standard error",
         .paper = "chaotic",
         .here = fmt::format("{}; by eq. (1) {}", text(here), text(other)),
         .number = over_error(here),
         .by_equation = over_error(other),
         .band = {3, infinity},
         .because = "positive by three standard errors"});
}

}  // namespace

void positive_exponents(
    Report& report, const std::string& where, const Response& here, const Response& other) {
    chaotic(report, where, here, other);
    const TransferProduct &product = here.run.exponents->product,
                          &by_equation = other.run.exponents->product;
    const double share = share_all_positive(product.raw_product_history());
    report.find(
        {.where = where,
         .what = "raw_product, second half of the window: share of impacts up to which all four "
                 "are positive",
         .paper = "four positive values",
         .here = fmt::format("{:.2f}; at the last {}", share, in_words(product.raw_product())),
         .number = share,
         .by_equation = share_all_positive(by_equation.raw_product_history()),
         .band = {0.9, 1},
         .because = "nine in ten; in part: more than half",
         .partly = Band{0.5, 1},
         .expected = Verdict::partly});
    const Exponents lambda = product.qr();
    report.find(
        {.where = where,
         .what = "positive exponents (qr)",
         .paper = "4",
         .here = fmt::format("{}: {}", positive(lambda), in_words(lambda)),
         .number = static_cast<double>(positive(lambda)),
         .by_equation = static_cast<double>(positive(by_equation.qr())),
         .band = exactly(4),
         .because = "all four",
         .expected = Verdict::not_reproduced});
}

double late_change(const ExponentHistory& h, int k) {
    const double half = (h.tau.front() + h.tau.back()) / 2;
    std::vector<double> late;
    for (std::size_t i = 0; i < h.tau.size(); ++i)
        if (h.tau[i] >= half && std::isfinite(h.lambda[i][k])) late.push_back(h.lambda[i][k]);
    const double last = late.back();
    return (quantile(late, 0.95) - quantile(late, 0.05)) / std::abs(last);
}

}  // namespace vines::report
