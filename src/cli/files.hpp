// Where a command reads its request and writes its answer.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>
#include <string_view>

namespace vines::cli {

/// Paths; "-" or "" stands for stdin and stdout.
struct Files {
    std::string input, output;
};
void add_files(CLI::App& command, Files& files);

/// Whether a path stands for stdin or stdout.
bool is_standard(const std::string& path);

/// Throws std::runtime_error with the reason where it cannot be read. read_file() knows no stdin.
std::string read_all(const std::string& path);
std::string read_file(const std::string& path);

/// Whether a text is JSON rather than a file of columns.
bool is_json(const std::string& text);

/// A text on its way to a file or stdout. A file is replaced at its end, at once: another one sees
/// the old text or the new. All throw std::runtime_error with the reason.
class Output {
public:
    explicit Output(const std::string& path);
    ~Output();
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;
    void write(std::string_view text);
    void end();

private:
    [[noreturn]] void fail();
    const std::string path_, next_;  // "" for stdout
    int file_;
};

/// The same of a whole text.
void write_all(const std::string& path, const std::string& text);

/// Appends lines to a file as they come, each in one write, so that a killed run keeps all of them.
class Appending {
public:
    /// Throws std::runtime_error with the reason where it cannot be written, as line() does.
    explicit Appending(const std::string& path);
    ~Appending() { std::fclose(file_); }
    Appending(const Appending&) = delete;
    Appending& operator=(const Appending&) = delete;
    void line(const std::string& text);

private:
    const std::string path_;
    std::FILE* file_;
};

}  // namespace vines::cli
