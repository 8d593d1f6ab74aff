// Width of the terminal, and progress of long work on stderr if that is a terminal.
#pragma once

#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <string>

namespace vines::cli {

// Width in columns if the terminal does not report it.
inline constexpr std::size_t usual_terminal_width = 80;

/// Width in columns; 0 if the stream is not a terminal.
std::size_t terminal_width(int stream = STDERR_FILENO);

/// Replaces a text of `before` characters in the current line of stderr. The text must fit into a
/// line.
void show_in_place(const std::string& text, std::size_t before);

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
    const bool shown_ = terminal_width() > 0;
    std::size_t length_ = 0;  ///< characters shown at present
    const Clock::time_point started_ = Clock::now();
    Clock::time_point drawn_{};
};

/// Current stage of a computation, shown in place.
class StageLine {
public:
    StageLine() = default;
    /// Clears the line.
    ~StageLine();
    StageLine(const StageLine&) = delete;
    StageLine& operator=(const StageLine&) = delete;
    void show(const std::string& stage);

private:
    const bool shown_ = terminal_width() > 0;
    std::size_t length_ = 0;  ///< characters shown at present
};

}  // namespace vines::cli
