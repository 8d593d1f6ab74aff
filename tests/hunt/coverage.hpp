// Coverage of the standard errors: how often windows of one motion differ from their mean by more
// than the stated errors allow.
#pragma once

namespace vines::hunt {

/// Prints a table: for each of twelve chaotic systems the percentage of `windows` windows of
/// `cycles` cycles whose exponents, x_rms, z and share_impacts lie outside the intervals that
/// should miss 31.7, 4.55 and 0.27 %.
void print_coverage(int windows, int cycles, int threads);

}  // namespace vines::hunt
