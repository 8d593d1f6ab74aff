#include "cli/progress_bar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <string>

namespace vines::cli {

namespace {

constexpr std::size_t width = 30;                         // characters
constexpr auto between = std::chrono::milliseconds(100);  // two drawings

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
    const double seconds = std::chrono::duration<double>(now - started_).count(),
                 rate = static_cast<double>(done_ - done_before_) / std::max(seconds, 1e-9);
    const std::size_t full = of_ ? width * done_ / of_ : width;
    std::string text = fmt::format(
        "\r[{}{}] {} of {} points", std::string(full, '#'), std::string(width - full, '.'), done_,
        of_);
    if (done_ > done_before_)
        text += fmt::format(
            ", {:.3g} per second, {:.0f} s left  ", rate, static_cast<double>(of_ - done_) / rate);
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

StageLine::~StageLine() { show(""); }

void StageLine::show(const std::string& stage) {
    if (!shown_) return;
    const std::string blank(length_, ' ');
    std::fputs(("\r" + blank + "\r" + stage).c_str(), stderr);
    std::fflush(stderr);
    length_ = stage.size();
}

}  // namespace vines::cli
