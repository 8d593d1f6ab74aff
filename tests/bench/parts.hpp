// What scripts/bench measures of the core and of answers; each part prints its rows.
#pragma once

namespace vines::bench {

/// Costs that grow with the work, and the memory that they take: first, in a process that has taken
/// little itself. `long_too`: a run of 1e6 cycles and a record of 1e6 samples as well.
void bench_growth(bool long_too);
/// Time per impact, beside the plain program.
void bench_kernel();
/// Sweeps of b, and a map over b and R.
void bench_sweeps();
/// The samples of a series, and an answer in the forms that it travels in.
void bench_answers();

}  // namespace vines::bench
