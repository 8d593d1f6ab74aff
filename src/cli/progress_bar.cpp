#include "cli/progress_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace vines::cli {

namespace {

constexpr std::size_t narrowest = 10;                     // characters between the brackets
constexpr auto between = std::chrono::milliseconds(100);  // two drawings

/// What fits a line without its last place, where some terminals break it.
std::string fitting(std::string text, std::size_t width) {
    text.resize(std::min(text.size(), width - std::min<std::size_t>(width, 1)));
    return text;
}

/// A bar in what a line has left beside words; where that is too little the words alone.
std::string with_bar(const std::string& words, double share, std::size_t width) {
    const std::size_t frame = words.size() + 4;  // brackets, a space, the last place
    if (width < frame + narrowest) return fitting(words, width);
    const std::size_t room = width - frame;
    const auto full = static_cast<std::size_t>(share * static_cast<double>(room));
    return fmt::format("[{:.<{}}] {}", std::string(full, '#'), room, words);
}

}  // namespace

ProgressBar::ProgressBar(std::size_t done, std::size_t of)
    : done_(done),
      of_(of),
      done_before_(done) {
    draw(true);
}

ProgressBar::~ProgressBar() {
    if (shown_) std::fputs("\n", stderr);
}

void ProgressBar::step() {
    ++done_;
    draw(done_ == of_);
}

void ProgressBar::draw(bool always) {
    const auto now = Clock::now();
    if (!shown_ || (!always && now - drawn_ < between)) return;
    drawn_ = now;
    const double share = of_ ? static_cast<double>(done_) / static_cast<double>(of_) : 1;
    const std::string line = with_bar(words(), share, terminal_width());
    show_in_place(line, length_);
    length_ = line.size();
}

std::string ProgressBar::words() const {
    std::string text = fmt::format("{} of {} points", done_, of_);
    if (done_ == done_before_) return text;
    const double seconds = std::chrono::duration<double>(Clock::now() - started_).count(),
                 rate = static_cast<double>(done_ - done_before_) / std::max(seconds, 1e-9);
    return text +
           fmt::format(
               ", {:.3g} per second, {:.0f} s left", rate, static_cast<double>(of_ - done_) / rate);
}

StageLine::~StageLine() { show(""); }

void StageLine::show(const std::string& stage) {
    if (!shown_) return;
    const std::string line = fitting(stage, terminal_width());
    show_in_place(line, length_);
    length_ = line.size();
}

}  // namespace vines::cli
