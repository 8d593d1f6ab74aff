// The process: its standard streams, the signals that end it, its cores.
#pragma once

#include <csignal>
#include <thread>

#include "program/descriptor.hpp"

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

/// Writes the whole text to stdout. Throws BrokenPipe if the pipe is closed, std::runtime_error
/// with the reason for any other error.
inline void print(std::string_view text) {
    if (const int failed = write_fully(STDOUT_FILENO, text)) fail_at("write", "to stdout", failed);
}

/// The text with its control characters as in JSON ("\u001b"), those above 127 in UTF-8 included.
/// A terminal obeys them, so a text quoted from a file or a request could clear it, retitle it, or
/// forge a line. kept: characters that stay.
inline std::string printable(std::string_view text, std::string_view kept = {}) {
    std::string shown;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const auto next = [&](std::size_t at) {
            return at < text.size() ? static_cast<unsigned char>(text[at]) : 0u;
        };
        const unsigned c = next(k), second = next(k + 1);
        if (c == 0xc2 && second >= 0x80 && second < 0xa0)
            fmt::format_to(std::back_inserter(shown), "\\u{:04x}", second), ++k;
        else if ((c < ' ' || c == 0x7f) && kept.find(text[k]) == std::string_view::npos)
            fmt::format_to(std::back_inserter(shown), "\\u{:04x}", c);
        else shown += text[k];
    }
    return shown;
}

/// Writes "vines: MESSAGE" to stderr, made printable. Ignores errors: a closed terminal does not
/// stop the computation.
inline void print_message(std::string_view message) {
    std::fputs(fmt::format("vines: {}\n", printable(message)).c_str(), stderr);
}

/// SIGTERM, SIGINT and SIGHUP end the program. One thread waits for them with sigwait(), outside a
/// signal handler, and therefore can take locks and write logs.
inline sigset_t end_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    // SIGHUP arrives when the terminal closes; it stays ignored under nohup.
    struct sigaction hangup{};
    sigaction(SIGHUP, nullptr, &hangup);
    if (hangup.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    return signals;
}

/// Blocks these signals in this thread and in those that it starts later. Call it before the first
/// thread is started.
inline void block_end_signals() {
    const sigset_t signals = end_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

/// Returns the next signal, including one that has arrived since they were blocked.
inline int wait_for_end_signal() {
    const sigset_t signals = end_signals();
    int signal = 0;
    sigwait(&signals, &signal);
    return signal;
}

/// Number of the machine's threads, at least 1.
inline int cores() { return static_cast<int>(std::max(1u, std::thread::hardware_concurrency())); }

}  // namespace vines
