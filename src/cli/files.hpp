// Where a command reads its request and writes its answer.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <string>

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

/// A file is replaced at once: another one sees the old text or the new. Throws std::runtime_error
/// with the reason.
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
