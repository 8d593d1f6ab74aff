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

void positive_exponents(
    Report& report, const std::string& where, const Response& r, Verdict raw_product) {
    const TransferProduct& product = r.run.exponents->product;
    const Exponents lambda = product.qr(), raw = product.raw_product();
    const double error = r.run.exponents->growth.standard_error[0];
    report.find(
        {.where = where,
         .what = "lambda1 (qr) over its standard error",
         .paper = "chaotic",
         .here = fmt::format("{:.4f} +- {:.4f}", lambda[0], error),
         .number = lambda[0] / error,
         .band = {3, infinity},
         .because = "positive by three standard errors"});
    const auto all_four = [&](const char* how, const Exponents& l, Verdict expected) {
        report.find(
            {.where = where,
             .what = how,
             .paper = "4",
             .here = fmt::format("{}: {}", positive(l), in_words(l)),
             .number = static_cast<double>(positive(l)),
             .band = exactly(4),
             .because = "all four",
             .expected = expected});
    };
    all_four("positive exponents, computed as in the paper (raw_product)", raw, raw_product);
    all_four("positive exponents (qr)", lambda, Verdict::not_reproduced);
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
