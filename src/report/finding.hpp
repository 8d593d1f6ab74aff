// One number of the paper, or one statement, beside what it turned out to be.
#pragma once

#include <string>

namespace vines::report {

/// Where a number must lie, ends included.
struct Band {
    double low, high;
    bool contains(double number) const { return number >= low && number <= high; }
};
inline Band exactly(double number) { return {number, number}; }

/// The texts are Markdown of one line, without a vertical bar. `vines reproduce` fails when a
/// number has left its band: then the verdict no longer stands, be it good or bad.
struct Finding {
    std::string where;    ///< in the paper: "Fig. 5"
    std::string what;     ///< the quantity
    std::string paper;    ///< what the paper says
    std::string here;     ///< what was computed
    std::string verdict;  ///< one of those below, or more of the kind
    double number;        ///< what the verdict rests on ...
    Band band;            ///< ... and where it must lie

    bool holds() const { return band.contains(number); }
};

inline const std::string reproduced = "reproduced";
/// By eq. (1) it would not be: see README, "What the paper says and what holds".
inline const std::string reproduced_with_closed_form = "reproduced with the closed-form damping";
inline std::string not_reproduced(const std::string& reason) { return "not reproduced: " + reason; }

}  // namespace vines::report
