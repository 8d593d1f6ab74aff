// The terminal that a stream is, if it is one.
#pragma once

#include <unistd.h>

#include <cstddef>
#include <string>

namespace vines::cli {

// Of one that does not say: characters.
inline constexpr std::size_t usual_terminal_width = 80;

/// Characters in a line of it; 0 where the stream is none.
std::size_t terminal_width(int stream = STDERR_FILENO);

/// On stderr. Puts a text in the place of one of so many characters that was shown so before. It
/// must fit a line.
void show_in_place(const std::string& text, std::size_t before);

}  // namespace vines::cli
