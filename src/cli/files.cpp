#include "cli/files.hpp"

#include <fcntl.h>
#include <unistd.h>

#include "program/process.hpp"

namespace vines::cli {

void add_output(CLI::App& command, std::string& path, const std::string& about) {
    add_file(command, "--output,-o", path, about);
}

void add_files(CLI::App& command, Files& files) {
    add_file(command, "request", files.input, "file with the request as JSON; - or nothing: stdin");
    add_output(command, files.output);
}

void add_plot_flag(CLI::App& command, bool& plot) {
    command
        .add_flag("--plot", plot, "draw plots instead, in the terminal or as SVG with -o FILE.svg")
        ->excludes(command.get_option("--format"));
}

bool is_standard(const std::string& path) { return path.empty() || path == "-"; }

bool is_json(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{';
}

std::string read_all(const std::string& path) {
    if (!is_standard(path)) return read_file(path);
    if (::isatty(STDIN_FILENO) == 1) print_message("reading from the terminal; Ctrl-D ends it");
    return read_open(STDIN_FILENO, "stdin");
}

std::string read_file(const std::string& path) {
    // A socket cannot be opened by its path.
    if (path == "/dev/stdin") return read_open(STDIN_FILENO, path);
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) fail_at("read", path);
    return read_open(file.number(), path);
}

std::string read_open(int descriptor, const std::string& name) {
    std::string text;
    if (const int failed = read_fully(descriptor, text)) fail_at("read", name, failed);
    return text;
}

}  // namespace vines::cli
