#include "cli/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cstdio>

namespace vines::cli {

namespace {

constexpr std::size_t min_bar = 10;  // characters between the brackets
constexpr auto update_interval = std::chrono::milliseconds(100);

/// A bar in the columns that the words leave free; only the words if that is too narrow.
std::string with_bar(const std::string& words, double fraction, std::size_t width) {
    const std::size_t frame = words.size() + 4;  // brackets, a space, the last column
    if (width < frame + min_bar) return words;
    const std::size_t columns = width - frame;
    const auto full = static_cast<std::size_t>(fraction * static_cast<double>(columns));
    return fmt::format("[{:.<{}}] {}", std::string(full, '#'), columns, words);
}

}  // namespace

std::size_t terminal_width(int stream) {
    if (::isatty(stream) != 1) return 0;
    winsize size{};
    const bool known = ::ioctl(stream, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : usual_terminal_width;
}

StatusLine::~StatusLine() { show(""); }

void StatusLine::keep() {
    if (is_shown_) std::fputs("\n", stderr);
    is_shown_ = false;
}

void StatusLine::show(const std::string& text) {
    if (!is_shown_) return;
    // Leaves the last column free, where some terminals wrap.
    const std::string shown = text.substr(0, std::max<std::size_t>(terminal_width(), 1) - 1);
    std::string line = "\r" + shown;
    if (shown.size() < length_) line += std::string(length_ - shown.size(), ' ') + "\r" + shown;
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
    length_ = shown.size();
}

ProgressBar::ProgressBar(std::size_t done, std::size_t total)
    : done_(done),
      total_(total),
      done_before_(done) {
    draw(true);
}

void ProgressBar::step() {
    ++done_;
    draw(done_ == total_);
}

void ProgressBar::draw(bool always) {
    const auto now = Clock::now();
    if (!line_.is_shown() || (!always && now - drawn_ < update_interval)) return;
    drawn_ = now;
    const double fraction = total_ ? static_cast<double>(done_) / static_cast<double>(total_) : 1;
    line_.show(with_bar(words(), fraction, terminal_width()));
}

std::string ProgressBar::words() const {
    std::string text = fmt::format("{} of {} points", done_, total_);
    if (done_ == done_before_) return text;
    const double seconds = std::chrono::duration<double>(Clock::now() - started_).count(),
                 rate = static_cast<double>(done_ - done_before_) / std::max(seconds, 1e-9);
    return text + fmt::format(
                      ", {:.3g} per second, {:.0f} s left", rate,
                      static_cast<double>(total_ - done_) / rate);
}

}  // namespace vines::cli
