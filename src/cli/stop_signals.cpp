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

/// What is stopped ends within a tenth of a second, whatever it waits for.
constexpr auto patience = std::chrono::milliseconds(80);

std::atomic<int> asked_by = 0;  // the signal

/// What a signal finds.
struct Work {
    std::mutex mutex;
    std::condition_variable left;
    bool stoppable = false;
    std::function<void()> last_words;
};

/// Never destroyed: the thread that waits for signals outlives main().
Work& work() {
    static auto* const all = new Work;
    return *all;
}

/// Whatever the other threads do: what they have written is written.
[[noreturn]] void end(int code) {
    remove_temporary_files();
    std::_Exit(code);
}

void end_when_asked() {
    const int signal = wait_for_end_signal();
    Work& w = work();
    std::unique_lock lock(w.mutex);
    if (!w.stoppable) end(128 + signal);
    asked_by = signal;
    const auto has_left = [&w] { return !w.stoppable; };
    if (w.last_words && !w.left.wait_for(lock, patience, has_left)) {
        w.last_words();
        end(stopped_code());
    }
    lock.unlock();
    end(128 + wait_for_end_signal());
}

}  // namespace

void stop_on_signals() {
    block_end_signals();
    std::thread(end_when_asked).detach();
}

bool stopped() { return asked_by != 0; }

int stopped_code() { return asked_by == SIGINT ? 128 + SIGINT : static_cast<int>(incomplete); }

Stoppable::Stoppable(std::function<void()> last_words) {
    const std::lock_guard lock(work().mutex);
    work().stoppable = true;
    work().last_words = std::move(last_words);
}

Stoppable::~Stoppable() {
    {
        const std::lock_guard lock(work().mutex);
        work().stoppable = false;
        work().last_words = nullptr;
    }
    work().left.notify_all();
}

Command ended_by_signals(Command command) {
    return {command.app, [run = std::move(command.run)] {
                stop_on_signals();
                return run();
            }};
}

}  // namespace vines::cli
