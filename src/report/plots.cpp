#include "report/plots.hpp"

#include <fmt/format.h>

namespace vines::report {

namespace {

Curve history(const ExponentHistory& h, int k) {
    Curve c{.x = h.tau, .colour = colours[k], .label = fmt::format("lambda{}", k + 1)};
    for (const Exponents& lambda : h.lambda) c.y.push_back(lambda[k]);
    return c;
}

Curve floor_of(const ExponentHistory& raw, double tau_start) {
    Curve c{.x = raw.tau, .colour = grey, .label = "rounding floor", .dash = "5 4"};
    for (std::size_t i = 0; i < raw.tau.size(); ++i)
        c.y.push_back(rounding_floor(raw.lambda[i][0], raw.tau[i] - tau_start));
    return c;
}

}  // namespace

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
    const ExponentHistory &raw = product.raw_product_history(), &qr = product.qr_history();
    Plot as_paper{.x_label = "tau", .y_label = "raw_product"},
        reference{.x_label = "tau", .y_label = "qr"};
    for (int k = 0; k < 4; ++k) {
        as_paper.curves.push_back(history(raw, k));
        reference.curves.push_back(history(qr, k));
    }
    as_paper.curves.push_back(floor_of(raw, product.start_tau()));
    for (Plot* p : {&as_paper, &reference}) {
        p->y_range = plot::late_range(p->curves);
        p->levels = {0};
    }
    return {as_paper, reference};
}

}  // namespace vines::report
