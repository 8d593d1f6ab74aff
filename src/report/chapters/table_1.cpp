// Table 1: the parameters that the paper rounds, from its SI values.
#include <fmt/format.h>

#include "report/chapters.hpp"

namespace vines::report {

void table_1(Report& report, Runs&) {
    const Parameters p;
    report.find(
        {.where = "Table 1",
         .what = "epsilon",
         .paper = ".84 %",
         .here = fmt::format("{:.4f} %", 100 * p.epsilon),
         .verdict = reproduced,
         .number = 100 * p.epsilon,
         .band = {0.835, 0.845}});
    report.find(
        {.where = "Table 1",
         .what = "lambda",
         .paper = "1.43",
         .here = fmt::format("{:.4f}", p.lambda),
         .verdict = reproduced,
         .number = p.lambda,
         .band = {1.425, 1.435}});
}

}  // namespace vines::report
