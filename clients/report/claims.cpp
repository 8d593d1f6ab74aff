#include "report/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

namespace vines::report {

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

/// lambda1 over its standard error.
double over_error(const WindowExponents& e) {
    return e.product.qr()[0] / e.growth.standard_error[0];
}

std::string with_error(const WindowExponents& e) {
    return fmt::format("{:.4f} +- {:.4f}", e.product.qr()[0], e.growth.standard_error[0]);
}

/// The four exponents of a history.
Plot plot_of(const ExponentHistory& h, const char* label) {
    Plot p{.x_label = "tau", .y_label = label, .levels = {0}};
    for (int k = 0; k < 4; ++k) {
        Curve c{.x = h.tau, .colour = colours[k], .label = fmt::format("lambda{}", k + 1)};
        for (const Exponents& lambda : h.lambda) c.y.push_back(lambda[k]);
        p.curves.push_back(std::move(c));
    }
    return p;
}

}  // namespace

std::string in_words(const Exponents& lambda) {
    return fmt::format(
        "{:.4f}, {:.4f}, {:.4f}, {:.4f}", lambda[0], lambda[1], lambda[2], lambda[3]);
}

Exponents exponents_of(const PaperRun& r) {
    const auto& orbit = r.regime().orbit;
    return orbit ? orbit->exponents(r.parameters) : r.product().qr();
}

void positive_exponents(Report& report, const PositiveExponents& paper, const BothRuns& runs) {
    const auto &here = *runs.here.run.exponents, &other = *runs.by_equation.run.exponents;
    report.add(
        {paper.where, "lambda1 (qr) over its standard error", paper.chaotic},
        {over_error(here), over_error(other),
         with_error(here) + "; by eq. (1) " + with_error(other)},
        {{student_95, infinity}, "positive: the 95 % interval lies above zero"});
    const Positive found = all_positive(here.product.raw_product_history());
    report.add(
        {paper.where,
         "raw_product, second half of the window without its spikes: fraction of impacts "
         "up to which all four are positive",
         paper.positive},
        {found.share, all_positive(other.product.raw_product_history()).share,
         "{:.2f}; at the last {}. At {:.2f} of all impacts an eigenvalue is zero: a spike",
         found.share, in_words(here.product.raw_product()), found.spikes},
        {{0.9, 1}, "nine in ten; spikes, which the paper mentions too, are left out"});
    const Exponents lambda = here.product.qr();
    report.add(
        {paper.where, "positive exponents (qr)", paper.positive, rounding_cause},
        {positive(lambda), positive(other.product.qr()),
         fmt::format("{}: {}", positive(lambda), in_words(lambda)) + paper.other_start},
        {exactly(4), "all four"}, not_reproduced);
}

Result result_of(const Typical& here, int decimals) {
    Result r(here.median, here.in_words(decimals));
    r.statistic = "median";
    return r;
}
Result result_of(const Typical& here, const Typical& other, int decimals) {
    Result r = result_of(here, decimals);
    r.by_equation = other.median;
    r.words += "; by eq. (1) " + other.in_words(decimals);
    return r;
}

void same_regime(
    Report& report, const std::string& where, RegimeType type, const BothRuns& runs,
    const std::string& words, ClaimVerdict expected) {
    const auto number = [](RegimeType t) { return static_cast<double>(t); };
    report.add(
        {where, "regime", std::string("Type ") + name_of(type)},
        {number(runs.here.regime().type), number(runs.by_equation.regime().type), words},
        {exactly(number(type)), "the same type as in the paper"}, expected);
}

double late_change(const ExponentHistory& h, int k) {
    std::vector<double> values;
    for (const Exponents& lambda : late(h))
        if (std::isfinite(lambda[k])) values.push_back(lambda[k]);
    const double last = values.back();
    return (quantile(values, 0.95) - quantile(values, 0.05)) / std::abs(last);
}

Plot displacement(const Series& series, double to) {
    Curve c;
    for (std::size_t i = 0; i < series.tau.size() && series.tau[i] <= to; ++i)
        c.add(series.tau[i], 1000 * series.x[i]);
    return {.x_label = "tau", .y_label = "x (mm)", .curves = {std::move(c)}};
}

Plot relative_displacement(const PaperRun& r, double from, double to) {
    Curve c;
    const auto add = [&](double tau, double gap) {
        if (tau >= from && tau <= to) c.add(tau, 1000 * gap);
    };
    const double b = r.parameters.b;
    auto impact = r.run.impacts.begin();
    for (std::size_t k = 0; k < r.run.series->tau.size(); ++k) {
        for (; impact != r.run.impacts.end() && impact->tau <= r.run.series->tau[k]; ++impact)
            add(impact->tau, -impact->side * b);
        add(r.run.series->tau[k], r.run.series->y[k] - r.run.series->x[k]);
    }
    return {
        .x_label = "tau",
        .y_label = "y - x (mm)",
        .curves = {std::move(c)},
        .levels = {-1000 * b, 1000 * b}};
}

std::vector<Plot> exponent_histories(const TransferProduct& product) {
    const ExponentHistory& raw = product.raw_product_history();
    Plot as_paper = plot_of(raw, "raw_product"), reference = plot_of(product.qr_history(), "qr");
    Curve floor{.x = raw.tau, .colour = grey, .label = "rounding floor", .dash = "5 4"};
    for (std::size_t i = 0; i < raw.tau.size(); ++i)
        floor.y.push_back(rounding_floor(raw.lambda[i][0], raw.tau[i] - product.start_tau()));
    as_paper.curves.push_back(std::move(floor));
    for (Plot* p : {&as_paper, &reference}) p->y_range = plot::late_range(p->curves);
    return {as_paper, reference};
}

}  // namespace vines::report
