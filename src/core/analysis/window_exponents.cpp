#include "core/analysis/window_exponents.hpp"

#include <cmath>

#include "core/stability/slope.hpp"

namespace vines {

WindowExponents window_exponents(
    const Interval& asked, TransferProduct&& product, const Growth& growth, const Regime& regime) {
    const Judgement judgement = judge(growth, regime, product.start_tau());
    const double start = product.start_tau();
    const ExponentSlopes slopes{
        coarse_slope(product.qr_history(), start),
        coarse_slope(product.eigenvalues_history(), start),
        coarse_slope(product.raw_product_history(), start)};
    return {asked, std::move(product), growth, slopes, judgement};
}

void add_warnings(
    const TransferProduct& product, const ExponentOptions& shown, bool histories,
    std::vector<Warning>& warnings) {
    if (histories && shown.raw_product && product.impacts() > 1 &&
        std::isnan(product.raw_product()[0]))
        warnings.push_back(warning::RawProductOverflows{});
    if (product.sum_rule_residual() > most_residual)
        warnings.push_back(warning::SumRuleMissed{
            product.start_tau(), product.end_tau(), product.sum_rule_residual()});
    if (!histories) return;
    if (product.impacts() < 2) warnings.push_back(warning::NoExponents{});
    if (product.rank() < 4) warnings.push_back(warning::RankLost{product.rank()});
}

}  // namespace vines
