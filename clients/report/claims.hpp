// Statements on regimes and exponents, plots and printed tables that several chapters use.
#pragma once

#include "core/motion/elementary.hpp"
#include "plot/plot.hpp"
#include "report/report.hpp"
#include "report/runs.hpp"

namespace vines::report {

std::string in_words(const Exponents& lambda);

/// Exponents of the orbit that the run approaches, else of the window.
Exponents exponents_of(const PaperRun& response);

/// Adds the finding on the regime of a figure. `words`: both results.
void same_regime(
    Report& report, const std::string& where, RegimeType type, const BothRuns& runs,
    const std::string& words, ClaimVerdict expected = reproduced);

/// The result that a median decides; `decimals` of the words.
Result result_of(const Typical& here, int decimals);
Result result_of(const Typical& here, const Typical& by_equation, int decimals);

/// Why the paper's second to fourth exponents are not what it prints.
inline const char* const rounding_cause = "rounding that stands for the second to fourth exponents";

/// Quotations: the place, that the motion is chaotic, and that its four exponents are positive.
/// `other_start`: the exponents (qr) from another start, in words.
struct PositiveExponents {
    std::string where, chaotic, positive, other_start{};
};
/// Adds the findings on chaos and positive exponents.
void positive_exponents(Report& report, const PositiveExponents& paper, const BothRuns& runs);

/// Range of the k-th exponent (0 to 3) over the second half of a window, without spikes (one value
/// in twenty at either end), over its last value.
double late_change(const ExponentHistory& history, int k);
/// late_change() of what the paper calls almost constant.
inline const Criterion almost_constant = {{0, 0.1}, "a tenth; in part: a fifth", Band{0, 0.2}};

using plot::Curve, plot::Plot, plot::colours, plot::grey, plot::red;

Plot displacement(const Series& series, double to = infinity);  ///< x in mm up to a time
/// y - x in mm over an interval of tau, with the walls.
Plot relative_displacement(const PaperRun& response, double from, double to);
/// Two plots. Above: the four exponents as the paper computed them (33), with their rounding floor.
/// Below: the exponents by QR.
std::vector<Plot> exponent_histories(const TransferProduct& product);

/// Table 2: exponents at b = 22 mm over three windows of one run.
struct Table2Row {
    double from, to;  ///< tau
    double lambda1, lambda3;
    double T() const { return to - from; }
    double spread() const { return (lambda1 - lambda3) * T(); }
};
inline constexpr Table2Row printed_table_2[] = {
    {18.1300, 1708.9, 0.1093, 0.08427},
    {1708.9, 3652.7, 0.1143, 0.09242},
    {3652.7, 5521.3, 0.1197, 0.1015}};

/// Table 3: exponents over windows that the paper does not state.
struct Table3Row {
    double b;  ///< m
    double lambda1, lambda3;
    double difference() const { return lambda1 - lambda3; }
};
inline constexpr Table3Row printed_table_3[] = {
    {0.040, 0.1321, 0.1245},   {0.034, 0.1372, 0.127},    {0.031, 0.1528, 0.1391},
    {0.028, 0.1452, 0.1309},   {0.025, 0.1138, 0.09727},  {0.022, 0.1093, 0.08427},
    {0.020, 0.1014, 0.0783},   {0.018, 0.06368, 0.03913}, {0.017, 0.04703, 0.02043},
    {0.0165, 0.03686, 0.01084}};
inline constexpr double highest_of_type_II = 0.031;  // m; lower rows are of Type II too

}  // namespace vines::report
