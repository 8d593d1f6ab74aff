// Plots in the characters of a terminal.
#pragma once

#include <string>
#include <vector>

#include "plot/plot.hpp"

namespace vines::plot {

struct Terminal {
    int width = 80;        ///< characters
    int height = 12;       ///< lines of each plot's frame
    bool colours = false;  ///< by ANSI's escape sequences
    bool ascii = false;    ///< no dots of Braille, eight in a character
};

/// Plots over each other with the same abscissa, as lines. Labels stand where their curves end;
/// points of several curves have their own marks where there are no colours; bands are left out.
std::string text(const std::vector<Plot>& plots, const Terminal& terminal);

}  // namespace vines::plot
