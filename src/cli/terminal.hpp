// Plots of answers; width of the terminal; progress of long work on stderr if that is a terminal.
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

/// Draws a run (its JSON) or a sweep (its lines): as SVG if the file's name ends with .svg, else in
/// characters. Throws std::runtime_error if the answer has nothing to draw, or like write_all().
void draw(const std::string& answer, const std::string& path);

/// Throws Problem if the file's name asks for an image format other than SVG. Call before
/// computing.
void check_plot_file(const std::string& path);

/// The current line of stderr, if that is a terminal.
class StatusLine {
public:
    StatusLine() = default;
    /// Clears the line, unless it is kept.
    ~StatusLine();
    StatusLine(const StatusLine&) = delete;
    StatusLine& operator=(const StatusLine&) = delete;
    bool is_shown() const { return is_shown_; }
    /// Replaces the text, shortened to the terminal's width.
    void show(const std::string& text);
    /// Ends the line.
    void keep();

private:
    bool is_shown_ = terminal_width() > 0;
    std::size_t length_ = 0;  ///< characters shown at present
};

/// Progress bar over the width of the terminal, which stays after the end.
class ProgressBar {
public:
    /// `done` of `total` points are complete at the start.
    ProgressBar(std::size_t done, std::size_t total);
    ~ProgressBar() { line_.keep(); }
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

}  // namespace vines::cli
