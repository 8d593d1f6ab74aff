#include "cli/terminal.hpp"

#include <sys/ioctl.h>

#include <cstdio>

namespace vines::cli {

std::size_t terminal_width(int stream) {
    if (::isatty(stream) != 1) return 0;
    winsize size{};
    const bool told = ::ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return told ? size.ws_col : usual_terminal_width;
}

void show_in_place(const std::string& text, std::size_t before) {
    std::string line = "\r" + text;
    if (text.size() < before) line += std::string(before - text.size(), ' ') + "\r" + text;
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
}

}  // namespace vines::cli
