#include "cli/terminal.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

namespace vines::cli {

namespace {

// Of one that does not say.
constexpr std::size_t usual_width = 80;

}  // namespace

std::size_t terminal_width() {
    if (::isatty(STDERR_FILENO) != 1) return 0;
    winsize size{};
    const bool told = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return told ? size.ws_col : usual_width;
}

void show_in_place(const std::string& text, std::size_t before) {
    std::string line = "\r" + text;
    if (text.size() < before) line += std::string(before - text.size(), ' ') + "\r" + text;
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace vines::cli
