// The numbers of the paper's tables that more than one chapter rests on.
#pragma once

namespace vines::report {

/// Table 2: exponents at b = 22 mm over three windows of one run.
struct Table2Row {
    double from, to;  ///< tau
    double lambda1, lambda3;
    double T() const { return to - from; }
    /// (lambda1 - lambda3) T.
    double spread() const { return (lambda1 - lambda3) * T(); }
};
inline constexpr Table2Row printed_table_2[] = {
    {18.1300, 1708.9, 0.1093, 0.08427},
    {1708.9, 3652.7, 0.1143, 0.09242},
    {3652.7, 5521.3, 0.1197, 0.1015}};

/// Table 3: exponents over windows that are not told.
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

}  // namespace vines::report
