// Where a command reads its request and writes its answer.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vines::cli {

/// Paths; "-" or "" stands for stdin and stdout.
struct Files {
    std::string input, output;
};
void add_files(CLI::App& command, Files& files);
void add_output(CLI::App& command, Files& files);
/// --plot, with the file that add_files() knows, in place of the --format that is there already.
void add_plot_flag(CLI::App& command, bool& plot);

/// Whether a path stands for stdin or stdout.
bool is_standard(const std::string& path);

/// Throws std::runtime_error with the reason where it cannot be read. read_file() knows no stdin.
std::string read_all(const std::string& path);
std::string read_file(const std::string& path);

/// The same of what is open, from where it stands; `name` in messages.
std::string read_open(int descriptor, const std::string& name);

/// Whether a text is JSON rather than a file of columns.
bool is_json(const std::string& text);

}  // namespace vines::cli
