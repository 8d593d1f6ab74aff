// Input and output files of a command.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vines::cli {

/// Paths; "-" or "" stands for stdin or stdout.
struct Files {
    std::string input, output;
};

/// Adds an option or a positional for a path or several ones, which shells complete.
template <class Paths>
CLI::Option* add_file(
    CLI::App& command, const std::string& names, Paths& paths, const std::string& about) {
    return command.add_option(names, paths, about)->type_name("FILE");
}
void add_output(
    CLI::App& command, std::string& path,
    const std::string& about = "file for the answer; - or nothing: stdout");
/// Adds the file with the request, and that for the answer.
void add_files(CLI::App& command, Files& files);
/// Adds --plot, which excludes --format. Call add_files() and add_format() before.
void add_plot_flag(CLI::App& command, bool& plot);

/// Returns whether a path stands for stdin or stdout.
bool is_standard(const std::string& path);

/// Return the whole content. Throw std::runtime_error with the reason if it cannot be read. Only
/// read_all() reads stdin for "" and "-".
std::string read_all(const std::string& path);
std::string read_file(const std::string& path);

/// Reads an open file from its current position to the end; `name` is used in messages.
std::string read_open(int descriptor, const std::string& name);

/// Returns whether a text is JSON rather than a file of columns.
bool is_json(const std::string& text);

}  // namespace vines::cli
