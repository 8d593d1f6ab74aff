// A pool of threads that take jobs from a queue. Clients take turns, and a client that has more
// threads than are left for all others gets no further one: one client has at most half of the
// threads, a second one at most a quarter, and so on.
#pragma once

#include <semaphore.h>

#include <functional>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>

#include "http/fair_queue.hpp"

namespace vines::http {

template <class Job>
class WorkerPool {
public:
    /// Starts threads when needed, `threads` at most; std::system_error if not even one starts. As
    /// many jobs wait for a thread. work(job) must not throw.
    WorkerPool(int threads, std::function<void(Job)> work)
        : max_threads_(static_cast<std::size_t>(threads)),
          work_(std::move(work)) {
        ::sem_init(&wake_, 0, 0);
        start_one();
    }
    /// Finishes the queued jobs.
    ~WorkerPool() {
        {
            const std::lock_guard lock(mutex_);
            ending_ = true;
        }
        ::sem_post(&wake_);
        for (std::thread& thread : threads_) thread.join();
        ::sem_destroy(&wake_);
    }
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;

    /// Queues a job. If the queue is full, returns the job that finds no place: this one, or the
    /// last one of a client that has more in the queue, or its share of threads.
    std::optional<Job> add(const std::string& client, Job job) {
        std::optional<Job> refused;
        {
            const std::lock_guard lock(mutex_);
            if (jobs_.size() >= free_ && threads_.size() < max_threads_) {
                try {
                    start_one();
                } catch (const std::system_error&) {}  // the existing threads do the work
            }
            if (jobs_.size() >= free_ + max_threads_) {
                refused = jobs_.pop_for(client);
                if (!refused && (!may_begin()(client) || may_begin()(jobs_.last_client())))
                    return job;
                if (!refused) refused = jobs_.pop_last();
            }
            jobs_.push(client, std::move(job));
        }
        ::sem_post(&wake_);
        return refused;
    }
    /// For a thread of the pool, as its last action: queues a job beyond the limit.
    void put_back(const std::string& client, Job job) {
        const std::lock_guard lock(mutex_);
        jobs_.push(client, std::move(job));
    }
    /// True if a job waits for a thread, other than one whose client has its share.
    bool jobs_wait() {
        const std::lock_guard lock(mutex_);
        return jobs_.size() > free_ && jobs_.clients(may_begin()) > 0;
    }

    /// True if a job waits for a thread whose client has none, or so few that one of this client's
    /// would make them more equal; `even_last`: also for a client with a single thread.
    bool others_need(const std::string& client, bool even_last) {
        const std::lock_guard lock(mutex_);
        const std::size_t own = threads_of(client);
        if (jobs_.size() <= free_ || own < (even_last ? 1 : 2)) return false;
        const auto is_behind = [&](const std::string& one) {
            const std::size_t theirs = threads_of(one);
            return one != client && (theirs == 0 || theirs + 1 < own);
        };
        return jobs_.clients(is_behind) > 0;
    }

private:
    void start_one() {
        threads_.emplace_back([this] { run(); });
        ++free_;
    }

    std::size_t threads_of(const std::string& client) const {
        const auto running = running_.find(client);
        return running == running_.end() ? 0 : running->second;
    }

    /// Whether a client has fewer threads than are left.
    auto may_begin() const {
        const std::size_t left = max_threads_ - (threads_.size() - free_);
        return [this, left](const std::string& client) {
            const std::size_t own = threads_of(client);
            return own == 0 || own < left;
        };
    }

    void run() {
        std::unique_lock lock(mutex_);
        while (!(ending_ && jobs_.empty())) {
            std::string client;
            auto job = jobs_.pop([&](const std::string& next) {
                client = next;
                return may_begin()(next);
            });
            if (!job) {
                lock.unlock();
                while (::sem_wait(&wake_) != 0 && errno == EINTR) {}
                lock.lock();
                continue;
            }
            --free_;
            const auto running = running_.try_emplace(client).first;
            ++running->second;
            lock.unlock();
            work_(std::move(*job));
            lock.lock();
            if (--running->second == 0) running_.erase(running);
            ++free_;
        }
        ::sem_post(&wake_);  // for the next thread
    }

    const std::size_t max_threads_;
    const std::function<void(Job)> work_;
    std::mutex mutex_;
    /// Posted once per job, and by each thread at the end; a thread looks for another job before it
    /// waits. A semaphore, because posting never blocks: notifying a condition variable can block
    /// until previously woken threads have run, and the thread that adds jobs also answers health
    /// checks.
    sem_t wake_{};
    FairQueue<Job> jobs_;
    std::map<std::string, std::size_t> running_;  // jobs by client
    bool ending_ = false;
    std::size_t free_ = 0;  // threads without a job
    std::vector<std::thread> threads_;
};

}  // namespace vines::http
