// SIGTERM, SIGINT and SIGHUP, which ask the program to end, are waited for by a thread instead of
// interrupting one: that thread may take locks and write logs.
#pragma once

#include <csignal>

namespace vines {

inline sigset_t end_signals() {
    sigset_t signals;
    sigemptyset(&signals);
    // Of a terminal that goes away, unless the program is to outlive it (nohup).
    struct sigaction hangup{};
    sigaction(SIGHUP, nullptr, &hangup);
    if (hangup.sa_handler != SIG_IGN) sigaddset(&signals, SIGHUP);
    sigaddset(&signals, SIGTERM);
    sigaddset(&signals, SIGINT);
    return signals;
}

/// Keeps them from this thread and those that it starts from now on: call it before the first one.
inline void block_end_signals() {
    const sigset_t signals = end_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
}

/// Returns the next that comes, or that came since they were blocked.
inline int wait_for_end_signal() {
    const sigset_t signals = end_signals();
    int signal = 0;
    sigwait(&signals, &signal);
    return signal;
}

}  // namespace vines
