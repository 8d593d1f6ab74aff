// Queue of a sweep's lines between the threads that compute them and the one that sends them.
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
    /// To be called after the last line.
    void finish() {
        {
            const std::lock_guard lock(mutex_);
            finished_ = true;
        }
        changed_.notify_all();
    }

    struct Taken {
        std::string text;       ///< lines since the last call
        std::size_t count = 0;  ///< lines so far
        bool finished = false;  ///< no more will come
    };
    /// Waits for lines, for at most `at_most`. One thread at a time.
    Taken take(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [this] { return !text_.empty() || finished_; });
        Taken taken{std::exchange(text_, {}), count_, finished_};
        size_ = 0;
        lock.unlock();
        changed_.notify_all();
        return taken;
    }

    /// True while the queue is full; producers should wait.
    bool is_full() const { return size_ > capacity_; }
    /// Waits until the queue is not full, for at most `at_most`.
    void wait_while_full(std::chrono::milliseconds at_most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, at_most, [this] { return !is_full(); });
    }

private:
    static constexpr std::size_t capacity_ = 1 << 20;  // bytes

    std::mutex mutex_;
    std::condition_variable changed_;
    std::string text_;
    std::atomic<std::size_t> size_ = 0;  // bytes of text_; is_full() reads it without the mutex
    std::size_t count_ = 0;
    bool finished_ = false;
};

}  // namespace vines::http
