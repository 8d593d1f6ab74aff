// Memory: the budget of requests and answers held for all clients (--memory-limit), and what malloc
// keeps.
#pragma once

#include <unistd.h>

#include <cstdlib>  // __GLIBC__

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <utility>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace vines::http {

/// Thread-safe.
class MemoryBudget {
public:
    using Clock = std::chrono::steady_clock;

    explicit MemoryBudget(std::size_t limit) : limit_(limit) {}
    /// True if nothing large should be accepted.
    bool is_full() const { return held_ >= limit_; }
    /// True if `more` bytes should not be accepted of a client: also if it would then hold more
    /// than is left. One client so has half of the budget, a second one a quarter, and so on; but
    /// more than a quarter alone, as long as it is not full. for_long: held while it is computed;
    /// if that is large, half of the budget must stay free.
    bool is_full_for(const std::string& client, std::size_t more, bool for_long = false) const {
        const std::lock_guard lock(mutex_);
        const auto own = clients_.find(client);
        const std::size_t held = own == clients_.end() ? 0 : own->second;
        const bool full = is_full() || held + std::min(more, limit_ / 4) >= limit_ - held_ ||
                          (for_long && more > limit_ / 16 && held_ + more > limit_ / 2);
        if (full) last_full_ = Clock::now();
        return full;
    }
    /// Time at which it was last full, also for one client alone.
    Clock::time_point last_full() const {
        const std::lock_guard lock(mutex_);
        return last_full_;
    }
    std::size_t bytes() const { return held_; }
    /// The largest bytes() since the last call.
    std::size_t take_most() {
        const std::lock_guard lock(mutex_);
        return std::exchange(most_, held_);
    }

    struct Counted {
        std::string client;
        std::size_t bytes = 0;
    };
    /// Counts these bytes of a client instead of what was counted.
    void count(Counted& counted, const std::string& client, std::size_t bytes) {
        const std::lock_guard lock(mutex_);
        held_ += bytes - counted.bytes;
        most_ = std::max(most_, held_.load());
        if (counted.bytes > 0) {
            const auto before = clients_.find(counted.client);
            if ((before->second -= counted.bytes) == 0) clients_.erase(before);
        }
        if (bytes > 0) clients_[client] += bytes;
        counted = {client, bytes};
    }

private:
    const std::size_t limit_;
    std::atomic<std::size_t> held_ = 0;
    mutable std::mutex mutex_;
    std::size_t most_ = 0;
    mutable Clock::time_point last_full_ = {};
    std::map<std::string, std::size_t> clients_;  // bytes of each
};

/// Limits the memory that malloc keeps. Blocks of 1 MiB and more are mapped one by one: glibc's own
/// threshold grows up to 32 MiB with what is freed, and a run that waits would keep the pages that
/// it reserved and has not written. Below it each arena keeps enough for one answer
/// of tens of thousands of numbers, because each page requested anew costs a microsecond. There are
/// no more arenas than computing threads.
inline void configure_malloc([[maybe_unused]] int computing) {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
    mallopt(M_TRIM_THRESHOLD, 8 << 20);
    mallopt(M_ARENA_MAX, computing);
#endif
}

/// Memory of this process, bytes; 0 where the system does not tell.
struct ProcessMemory {
    std::size_t mapped = 0, resident = 0;
};
inline ProcessMemory process_memory() {
    std::ifstream status("/proc/self/statm");
    std::size_t mapped = 0, resident = 0;
    status >> mapped >> resident;
    const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
    return {mapped * page, resident * page};
}

/// Returns free memory to the system, after large requests and answers.
inline void trim_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace vines::http
