#include "cli/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace vines::cli {

namespace {

constexpr std::size_t min_bar = 10;  // characters between the brackets
constexpr auto update_interval = std::chrono::milliseconds(100);

/// Shortens a text to the line, without its last column, where some terminals wrap.
std::string shortened(std::string text, std::size_t width) {
    text.resize(std::min(text.size(), width - std::min<std::size_t>(width, 1)));
    return text;
}

/// A bar in the columns that the words leave free; only the words if that is too narrow.
std::string with_bar(const std::string& words, double fraction, std::size_t width) {
    const std::size_t frame = words.size() + 4;  // brackets, a space, the last column
    if (width < frame + min_bar) return shortened(words, width);
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

void show_in_place(const std::string& text, std::size_t before) {
    std::string line = "\r" + text;
    if (text.size() < before) line += std::string(before - text.size(), ' ') + "\r" + text;
    std::fputs(line.c_str(), stderr);
    std::fflush(stderr);
}

ProgressBar::ProgressBar(std::size_t done, std::size_t total)
    : done_(done),
      total_(total),
      done_before_(done) {
    draw(true);
}

ProgressBar::~ProgressBar() {
    if (shown_) std::fputs("\n", stderr);
}

void ProgressBar::step() {
    ++done_;
    draw(done_ == total_);
}

void ProgressBar::draw(bool always) {
    const auto now = Clock::now();
    if (!shown_ || (!always && now - drawn_ < update_interval)) return;
    drawn_ = now;
    const double fraction = total_ ? static_cast<double>(done_) / static_cast<double>(total_) : 1;
    const std::string line = with_bar(words(), fraction, terminal_width());
    show_in_place(line, length_);
    length_ = line.size();
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

StageLine::~StageLine() { show(""); }

void StageLine::show(const std::string& stage) {
    if (!shown_) return;
    const std::string line = shortened(stage, terminal_width());
    show_in_place(line, length_);
    length_ = line.size();
}

}  // namespace vines::cli
