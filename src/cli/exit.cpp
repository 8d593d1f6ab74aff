#include "cli/exit.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <utility>

#include "cli/files.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

const char* const exit_codes =
    "Exit codes:\n"
    "  0    complete\n"
    "  1    a file cannot be read or written, or the files do not belong together\n"
    "  2    invalid request; a problem document on stderr gives the reason\n"
    "  3    ended by SIGTERM, or points are missing; the output so far is usable\n"
    "  130  ended by Ctrl-C; the output so far is kept\n"
    "  141  the reader of the output closed the pipe\n"
    "  143  ended by SIGTERM before any output";

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

bool stopped() { return stop_signal != 0; }

int stopped_code() { return stop_signal == SIGINT ? 128 + SIGINT : static_cast<int>(incomplete); }

Stoppable::Stoppable(std::function<void()> final_message) {
    const std::lock_guard lock(work().mutex);
    work().stoppable = true;
    work().final_message = std::move(final_message);
}

Stoppable::~Stoppable() {
    const std::lock_guard lock(work().mutex);
    work().stoppable = false;
    work().final_message = nullptr;
    work().finished.notify_all();
}

Command ended_by_signals(Command command) {
    return {command.app, [run = std::move(command.run)] {
                block_end_signals();
                std::thread(wait_for_signals).detach();
                return run();
            }};
}

Command with_exit_codes(CLI::App* app, std::function<int()> run, const std::string& examples) {
    add_examples(*app, examples, exit_codes);
    const auto reporting = [run = std::move(run)]() -> int {
        try {
            return run();
        } catch (const api::Problem& problem) {
            std::fputs((printable(problem.body(), "\n") + "\n").c_str(), stderr);
            return refused;
        }
    };
    return ended_by_signals({app, reporting});
}

}  // namespace vines::cli
