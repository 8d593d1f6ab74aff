// The terminal that stderr is, if it is one.
#pragma once

#include <cstddef>
#include <string>

namespace vines::cli {

/// Characters in a line of it, 80 where it does not say; 0 where stderr is none.
std::size_t terminal_width();

/// Puts a text in the place of one of so many characters that was shown so before. It must fit a
/// line.
void show_in_place(const std::string& text, std::size_t before);

}  // namespace vines::cli
