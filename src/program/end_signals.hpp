// SIGTERM, SIGINT and SIGHUP end the program. One thread waits for them with sigwait(), outside a
// signal handler, and therefore can take locks and write logs.
#pragma once

#include <csignal>

namespace vines {

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

}  // namespace vines
