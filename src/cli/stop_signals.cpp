#include "cli/stop_signals.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <csignal>
#include <cstdlib>
#include <mutex>
#include <thread>
#include <utility>

#include "cli/exit_code.hpp"
#include "cli/temporary_file.hpp"
#include "program/end_signals.hpp"

namespace vines::cli {

namespace {

/// A stopped command ends within .1 s, whatever it waits for.
constexpr auto grace_period = std::chrono::milliseconds(80);

std::atomic<int> stop_signal = 0;  // the signal's number

/// State shared with the signal thread.
struct Work {
    std::mutex mutex;
    std::condition_variable finished;
    bool stoppable = false;
    std::function<void()> final_message;
};

/// Never destroyed: the signal thread outlives main().
Work& work() {
    static auto* const all = new Work;
    return *all;
}

/// Ends the process without waiting for other threads. Completed writes are kept.
[[noreturn]] void end(int code) {
    remove_temporary_files();
    std::_Exit(code);
}

void wait_for_signals() {
    const int signal = wait_for_end_signal();
    Work& w = work();
    std::unique_lock lock(w.mutex);
    if (!w.stoppable) end(128 + signal);
    stop_signal = signal;
    const auto has_finished = [&w] { return !w.stoppable; };
    if (w.final_message && !w.finished.wait_for(lock, grace_period, has_finished)) {
        w.final_message();
        end(stopped_code());
    }
    lock.unlock();
    end(128 + wait_for_end_signal());
}

}  // namespace

void stop_on_signals() {
    block_end_signals();
    std::thread(wait_for_signals).detach();
}

bool stopped() { return stop_signal != 0; }

int stopped_code() { return stop_signal == SIGINT ? 128 + SIGINT : static_cast<int>(incomplete); }

Stoppable::Stoppable(std::function<void()> final_message) {
    const std::lock_guard lock(work().mutex);
    work().stoppable = true;
    work().final_message = std::move(final_message);
}

Stoppable::~Stoppable() {
    {
        const std::lock_guard lock(work().mutex);
        work().stoppable = false;
        work().final_message = nullptr;
    }
    work().finished.notify_all();
}

Command ended_by_signals(Command command) {
    return {command.app, [run = std::move(command.run)] {
                stop_on_signals();
                return run();
            }};
}

}  // namespace vines::cli
