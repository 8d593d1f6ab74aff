// Standard streams: preparation, output on stdout, messages on stderr.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace vines {

/// Ignores SIGPIPE and SIGXFSZ, so that a failing write returns an error. Opens a standard stream
/// that was closed before the start on /dev/null in the wrong direction, so that its use fails:
/// otherwise the first file opened would get its number, and messages for stderr would end up in
/// that file. Call before any file is opened.
inline void prepare_streams() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // raised at the limit of `ulimit -f`
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0)  // open() takes the lowest free number: this one
            (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

/// Writes the whole text with repeated calls of write(). Returns 0, or errno of the call that
/// failed.
inline int write_fully(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = ::write(descriptor, text.data(), text.size());
        if (n >= 0) {
            text.remove_prefix(static_cast<std::size_t>(n));
        } else if (errno == EAGAIN) {  // made non-blocking by a process that shares the stream
            pollfd writable{descriptor, POLLOUT, 0};
            ::poll(&writable, 1, -1);
        } else if (errno != EINTR) {
            return errno;
        }
    }
    return 0;
}

/// Thrown when the reader of the output has closed its end of the pipe. The command then ends
/// without a message, because it is no std::exception, whose text is printed.
struct BrokenPipe {};

/// Exit code after BrokenPipe, the same as for a program ended by SIGPIPE: 128 + 13.
inline constexpr int broken_pipe_code = 141;

/// Writes the whole text to stdout. Throws BrokenPipe if the pipe is closed, std::runtime_error
/// with the reason for any other error.
inline void print(std::string_view text) {
    const int failed = write_fully(STDOUT_FILENO, text);
    if (failed == EPIPE) throw BrokenPipe();
    if (failed != 0)
        throw std::runtime_error(fmt::format("cannot write to stdout: {}", std::strerror(failed)));
}

/// Writes "vines: MESSAGE" to stderr. Ignores errors: a closed terminal does not stop the
/// computation.
inline void print_message(std::string_view message) {
    std::fputs(fmt::format("vines: {}\n", message).c_str(), stderr);
}

}  // namespace vines
