#include "cli/files.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>

#include "program/descriptor.hpp"
#include "program/standard_streams.hpp"

namespace vines::cli {

namespace {

constexpr std::size_t piece_read = 1 << 16;

/// Initial buffer size. For a regular file it is one byte more than the file, so that read()
/// reaches the end without enlarging the buffer.
std::size_t size_of(int descriptor) {
    struct stat entry{};
    const bool known = ::fstat(descriptor, &entry) == 0 && S_ISREG(entry.st_mode);
    return known ? static_cast<std::size_t>(entry.st_size) + 1 : piece_read;
}

}  // namespace

void add_files(CLI::App& command, Files& files) {
    command
        .add_option("request", files.input, "file with the request as JSON; - or nothing: stdin")
        ->type_name("FILE");
    add_output(command, files);
}

void add_output(CLI::App& command, Files& files) {
    command.add_option("--output,-o", files.output, "file for the answer; - or nothing: stdout")
        ->type_name("FILE");
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
    if (path == "/dev/stdin")
        return read_open(STDIN_FILENO, path);  // a socket cannot be opened by
                                               // its path
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) fail_at("read", path);
    return read_open(file.number(), path);
}

std::string read_open(int descriptor, const std::string& name) {
    std::string text(size_of(descriptor), '\0');
    std::size_t length = 0;
    for (;;) {
        if (length == text.size()) text.resize(2 * length);
        const ssize_t n = ::read(descriptor, text.data() + length, text.size() - length);
        if (n == 0) break;
        if (n > 0) {
            length += static_cast<std::size_t>(n);
        } else if (errno == EAGAIN) {  // set non-blocking by another process
            pollfd readable{descriptor, POLLIN, 0};
            ::poll(&readable, 1, -1);
        } else if (errno != EINTR) {
            fail_at("read", name);
        }
    }
    text.resize(length);
    return text;
}

}  // namespace vines::cli
