#include "report/reproduce.hpp"

#include <filesystem>

#include "report/chapters.hpp"
#include "report/markdown.hpp"

namespace vines::report {

namespace {

/// As they are read, one after the other.
constexpr Chapter* chapters[] = {
    model,                // Table 1, eqs. (8) to (11)
    strongly_modulated,   // Figs. 3 and 4
    transient_exponents,  // Fig. 5
    transfer_matrices,    // Figs. 6 to 9
    table_2,
    other_regimes,  // Figs. 10 to 14
    table_3,
    experiment,  // Table 4, Figs. 15 to 24
    open_questions,
};

}  // namespace

Report reproduce(const std::string& folder) {
    // Before the work: a folder that cannot be is found out at once.
    if (!folder.empty()) std::filesystem::create_directories(folder);
    Report report;
    Runs runs;
    for (Chapter* chapter : chapters) chapter(report, runs);
    if (!folder.empty()) write_markdown(report, folder);
    return report;
}

}  // namespace vines::report
