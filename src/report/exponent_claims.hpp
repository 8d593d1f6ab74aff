// What the paper says of exponents at more than one place.
#pragma once

#include "report/report.hpp"
#include "report/runs.hpp"

namespace vines::report {

std::string in_words(const Exponents& lambda);

/// Of the orbit that the run has come to, else of the window.
Exponents exponents_of(const Response& response);

/// Where the paper says that a motion is chaotic and that its four exponents are positive, and how.
struct PositiveExponents {
    std::string where, chaotic, positive;
};
/// `other`: by eq. (1).
void positive_exponents(
    Report& report, const PositiveExponents& paper, const Response& here, const Response& other);

/// How far the k-th exponent (0 to 3) comes over the second half of a window, but for its spikes
/// (one value in twenty at either end), over its last value.
double late_change(const ExponentHistory& history, int k);
/// Almost constant, and nearly so.
inline constexpr double small_change = 0.1, some_change = 0.2;
inline const char* const why_small_change = "a tenth; in part: a fifth";

}  // namespace vines::report
