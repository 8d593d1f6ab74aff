// How far work has come, on stderr where that is a terminal.
#pragma once

#include <chrono>
#include <cstddef>
#include <string>

#include "cli/terminal.hpp"

namespace vines::cli {

/// As wide as the terminal.
class ProgressBar {
public:
    /// `done` points of `of` are done already.
    ProgressBar(std::size_t done, std::size_t of);
    /// Leaves the line of the bar.
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    /// One more is done.
    void step();

private:
    using Clock = std::chrono::steady_clock;
    void draw(bool always);
    std::string words() const;
    std::size_t done_;
    const std::size_t of_, done_before_;
    const bool shown_ = terminal_width() > 0;
    std::size_t length_ = 0;  ///< of what stands there
    const Clock::time_point started_ = Clock::now();
    Clock::time_point drawn_{};
};

/// What work is at, in the same place.
class StageLine {
public:
    StageLine() = default;
    /// Wipes it.
    ~StageLine();
    StageLine(const StageLine&) = delete;
    StageLine& operator=(const StageLine&) = delete;
    void show(const std::string& stage);

private:
    const bool shown_ = terminal_width() > 0;
    std::size_t length_ = 0;  ///< of what stands there
};

}  // namespace vines::cli
