// Threads that take jobs from a queue, first come, first served.
#pragma once

#include <semaphore.h>

#include <cerrno>
#include <deque>
#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace vines::http {

template <class Job>
class Workers {
public:
    /// Up to so many threads, started when they are needed, and as far as the system has them: one
    /// there is, else std::system_error. work(job) throws nothing. At most `waiting` jobs wait
    /// beside those in work.
    Workers(int threads, std::size_t waiting, std::function<void(Job)> work)
        : most_threads_(static_cast<std::size_t>(threads)),
          most_(waiting),
          work_(std::move(work)) {
        ::sem_init(&calls_, 0, 0);
        start_one();
    }
    /// After the jobs that wait.
    ~Workers() {
        for (std::size_t n = 0; n < threads_.size(); ++n) ::sem_post(&calls_);
        for (std::thread& thread : threads_) thread.join();
        ::sem_destroy(&calls_);
    }
    Workers(const Workers&) = delete;
    Workers& operator=(const Workers&) = delete;

    /// False where too many wait: the job stays where it is.
    bool add(Job& job) {
        {
            const std::lock_guard lock(mutex_);
            if (jobs_.size() >= free_ && threads_.size() < most_threads_) try_to_start_one();
            if (jobs_.size() >= free_ + most_) return false;
            jobs_.push_back(std::move(job));
        }
        ::sem_post(&calls_);
        return true;
    }
    /// Whether a job waits for one.
    bool wanted() {
        const std::lock_guard lock(mutex_);
        return jobs_.size() > free_;
    }

private:
    void start_one() {
        threads_.emplace_back([this] { run(); });
        ++free_;
    }
    void try_to_start_one() {
        try {
            start_one();
        } catch (const std::system_error&) {  // those that are there do it
        }
    }

    void run() {
        for (;;) {
            wait_for_call();
            std::unique_lock lock(mutex_);
            if (jobs_.empty()) return;
            Job job = std::move(jobs_.front());
            jobs_.pop_front();
            --free_;
            lock.unlock();
            work_(std::move(job));
            lock.lock();
            ++free_;
        }
    }

    void wait_for_call() {
        while (::sem_wait(&calls_) != 0 && errno == EINTR) {}
    }

    const std::size_t most_threads_, most_;
    const std::function<void(Job)> work_;
    std::mutex mutex_;
    /// One for each job, and for each thread once there will be no more. To call waits for nobody:
    /// who notifies a condition may wait until those that it woke before have had a processor, and
    /// the thread that adds jobs answers health, too.
    sem_t calls_{};
    std::deque<Job> jobs_;
    std::size_t free_ = 0;  // of the threads
    std::vector<std::thread> threads_;
};

}  // namespace vines::http
