// stdin, stdout and stderr as a program finds them.
#pragma once

#include <fcntl.h>
#include <unistd.h>

#include <csignal>

namespace vines {

/// A write that fails says so instead of ending the process. And a stream that was closed before
/// the start stays one that cannot be used: else the first file that is opened would take its
/// place, and what is told on stderr would stand in somebody's answer. Call it first of all.
inline void prepare_streams() {
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);  // of `ulimit -f`
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(stream, F_GETFD) < 0)  // open() takes the lowest number that is free: this one
            (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

}  // namespace vines
