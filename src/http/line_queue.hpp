// Lines on their way from the threads that compute them to the one that sends them.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <utility>

namespace vines::http {

class LineQueue {
public:
    void push(const std::string& line) {
        {
            const std::lock_guard lock(mutex_);
            text_ += line;
            text_ += '\n';
            size_ = text_.size();
            ++count_;
        }
        changed_.notify_all();
    }
    /// No line follows.
    void finish() {
        {
            const std::lock_guard lock(mutex_);
            finished_ = true;
        }
        changed_.notify_all();
    }

    struct Taken {
        std::string text;       ///< the lines since the last call
        std::size_t count = 0;  ///< of all lines so far
        bool finished = false;  ///< and that is all
    };
    /// Waits for something to come, for so long at most. By one thread at a time.
    Taken take(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [this] { return !text_.empty() || finished_; });
        Taken taken{std::exchange(text_, {}), count_, finished_};
        size_ = 0;
        lock.unlock();
        changed_.notify_all();
        return taken;
    }

    /// Whether the lines come faster than they are taken: who computes more should wait.
    bool is_full() const { return size_ > most_; }
    /// Until that is over, for so long at most.
    void wait_for_room(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [this] { return !is_full(); });
    }

private:
    static constexpr std::size_t most_ = 1 << 20;  // bytes

    std::mutex mutex_;
    std::condition_variable changed_;
    std::string text_;
    std::atomic<std::size_t> size_ = 0;  // of the text; read without the mutex by who only looks
    std::size_t count_ = 0;
    bool finished_ = false;
};

}  // namespace vines::http
