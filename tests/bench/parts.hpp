// Parts of the benchmark of the core and of answers (scripts/bench); each prints its rows.
#pragma once

namespace vines::bench {

/// Costs that grow with the work, and its memory. Run it first, in a process that has used little
/// memory. `long_too` adds a run of 1e6 cycles and a record of 1e6 samples.
void bench_growth(bool long_too);
/// Time per impact, compared with the plain program.
void bench_kernel();
/// Sweeps over b, and a map over b and R.
void bench_sweeps();
/// Samples of a series, and an answer in its output formats.
void bench_answers();

}  // namespace vines::bench
