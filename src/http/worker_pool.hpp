// A pool of threads that take jobs from a queue, first come, first served.
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
class WorkerPool {
public:
    /// Starts threads when needed, `threads` at most; std::system_error if not even one starts. At
    /// most `waiting` jobs wait for a thread. work(job) must not throw.
    WorkerPool(int threads, std::size_t waiting, std::function<void(Job)> work)
        : max_threads_(static_cast<std::size_t>(threads)),
          max_waiting_(waiting),
          work_(std::move(work)) {
        ::sem_init(&wake_, 0, 0);
        start_one();
    }
    /// Finishes the queued jobs.
    ~WorkerPool() {
        for (std::size_t n = 0; n < threads_.size(); ++n) ::sem_post(&wake_);
        for (std::thread& thread : threads_) thread.join();
        ::sem_destroy(&wake_);
    }
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    /// Queues a job. False if the queue is full; the job is then left unchanged.
    bool add(Job& job) {
        {
            const std::lock_guard lock(mutex_);
            if (jobs_.size() >= free_ && threads_.size() < max_threads_) try_to_start_one();
            if (jobs_.size() >= free_ + max_waiting_) return false;
            jobs_.push_back(std::move(job));
        }
        ::sem_post(&wake_);
        return true;
    }
    /// True if a job waits for a thread.
    bool jobs_wait() {
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
        } catch (const std::system_error&) {  // the existing threads do the work
        }
    }

    void run() {
        for (;;) {
            wait_for_job();
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

    void wait_for_job() {
        while (::sem_wait(&wake_) != 0 && errno == EINTR) {}
    }

    const std::size_t max_threads_, max_waiting_;
    const std::function<void(Job)> work_;
    std::mutex mutex_;
    /// Posted once per job, and once per thread at the end. A semaphore, because posting never
    /// blocks: notifying a condition variable can block until previously woken threads have run,
    /// and the thread that adds jobs also answers health checks.
    sem_t wake_{};
    std::deque<Job> jobs_;
    std::size_t free_ = 0;  // threads without a job
    std::vector<std::thread> threads_;
};

}  // namespace vines::http
