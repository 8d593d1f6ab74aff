// Recomputes the paper's Figs. 3 to 14 and Tables 1 to 3 and sets its numbers beside ours.
#pragma once

#include <string>
#include <vector>

namespace vines::report {

/// One number of the paper, or one statement, and what it turned out to be.
struct Finding {
    std::string where;  ///< "Fig. 5"
    std::string what;   ///< the quantity
    std::string paper;  ///< what the paper says
    std::string here;   ///< what was computed
    double number;      ///< what the verdict rests on ...
    double low, high;   ///< ... and the band that it must lie in
    std::string verdict;

    bool holds() const { return number >= low && number <= high; }
};

struct Reproduction {
    std::vector<Finding> findings;
    bool holds() const;         ///< every number lies in its band
    std::string table() const;  ///< the findings as a Markdown table
};

/// Computes everything, and writes report.md and its SVG plots into the folder, which is created. A
/// folder "" writes nothing. Throws std::runtime_error where a file cannot be written.
Reproduction reproduce(const std::string& folder);

}  // namespace vines::report
