// Width of the terminal, and progress of long work on stderr if that is a terminal.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <string>

namespace vines::cli {

/// Width in columns if the terminal does not report it.
inline constexpr std::size_t usual_terminal_width = 80;

/// Width in columns; 0 if the stream is not a terminal.
std::size_t terminal_width(int stream = STDERR_FILENO);

/// The current line of stderr, if that is a terminal.
class StatusLine {
public:
    bool is_shown() const { return is_shown_; }
    /// Replaces the text, shortened to the terminal's width.
    void show(const std::string& text);

private:
    const bool is_shown_ = terminal_width() > 0;
    std::size_t length_ = 0;  ///< characters shown at present
};

/// Progress bar over the width of the terminal.
class ProgressBar {
public:
    /// `done` of `total` points are complete at the start.
    ProgressBar(std::size_t done, std::size_t total);
    /// Keeps the bar and ends its line.
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;
    /// Counts one more point.
    void step();

private:
    using Clock = std::chrono::steady_clock;
    void draw(bool always);
    std::string words() const;
    std::size_t done_;
    const std::size_t total_, done_before_;
    StatusLine line_;
    const Clock::time_point started_ = Clock::now();
    Clock::time_point drawn_{};
};

/// Current stage of a computation, shown in place.
class StageLine : public StatusLine {
public:
    StageLine() = default;
    /// Clears the line.
    ~StageLine() { show(""); }
    StageLine(const StageLine&) = delete;
    StageLine& operator=(const StageLine&) = delete;
};

}  // namespace vines::cli
