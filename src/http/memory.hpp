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
    /// more than a quarter alone, as long as it is not full. for_long: bytes of these that are held
    /// while more is computed, which have half of the budget, divided likewise.
    bool is_full_for(const std::string& client, std::size_t more, std::size_t for_long = 0) {
        const std::lock_guard lock(mutex_);
        return lacks(client, new_claim(client, more), for_long, false);
    }
    /// The same before the bytes are made, of a client that holds less than half of them; false for
    /// any other. Unless for_long, it then has a claim for 3 s: clients that hold more get nothing
    /// that it needs, and others wait in the order of time, later by 35 s times the part of the
    /// limit that they would hold.
    bool must_wait(const std::string& client, std::size_t more, std::size_t for_long = 0) {
        const std::lock_guard lock(mutex_);
        if (2 * bytes_of(client).all >= more) return false;
        std::erase_if(claims_, [](const auto& claim) { return claim.second.until < Clock::now(); });
        Claim claim = new_claim(client, more);
        const auto own = claims_.find(client);
        if (own != claims_.end() && own->second.bytes == more) claim.due = own->second.due;
        if (for_long == 0 && (own == claims_.end() || own->second.bytes <= more))
            claims_[client] = claim;
        return lacks(client, claim, for_long, true);
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

    struct Bytes {
        std::size_t all = 0, for_long = 0;
    };
    struct Counted {
        std::string client;
        Bytes bytes;
    };
    /// Counts these bytes of a client instead of what was counted.
    void count(Counted& counted, const std::string& client, Bytes bytes) {
        const std::lock_guard lock(mutex_);
        held_ += bytes.all - counted.bytes.all;
        held_for_long_ += bytes.for_long - counted.bytes.for_long;
        most_ = std::max(most_, held_.load());
        Bytes& before = clients_[counted.client];
        before.all -= counted.bytes.all, before.for_long -= counted.bytes.for_long;
        if (before.all == 0) clients_.erase(counted.client);
        Bytes& now = clients_[client];
        now.all += bytes.all, now.for_long += bytes.for_long;
        if (now.all == 0) clients_.erase(client);
        const auto claim = claims_.find(client);
        if (claim != claims_.end() && claim->second.bytes <= 2 * bytes.all) claims_.erase(claim);
        counted = {client, bytes};
    }

private:
    struct Claim {
        std::size_t bytes;
        Clock::time_point due, until;
    };
    Bytes bytes_of(const std::string& client) const {
        const auto found = clients_.find(client);
        return found == clients_.end() ? Bytes() : found->second;
    }
    Claim new_claim(const std::string& client, std::size_t more) const {
        const auto all = static_cast<double>(bytes_of(client).all + more);
        const std::chrono::duration<double> later(35 * all / static_cast<double>(limit_));
        const auto now = Clock::now();
        return {
            more, now + std::chrono::duration_cast<Clock::duration>(later),
            now + std::chrono::seconds(3)};
    }
    bool lacks(const std::string& client, const Claim& claim, std::size_t for_long, bool early) {
        const Bytes own = bytes_of(client);
        const bool holds_little = 2 * own.all < claim.bytes;
        std::size_t claimed = 0;
        for (const auto& [other, its] : claims_)
            if (for_long == 0 && other != client && its.due < claim.due &&
                its.until > Clock::now() && (early || !holds_little))
                claimed += std::min(its.bytes, limit_ / 4);
        const bool full = own.all + std::min(claim.bytes, limit_ / 4) + held_ + claimed >= limit_ ||
                          (for_long > 0 && own.for_long + for_long + held_for_long_ > limit_ / 2);
        if (is_full() || (full && holds_little)) last_full_ = Clock::now();
        return full;
    }

    const std::size_t limit_;
    std::atomic<std::size_t> held_ = 0;
    mutable std::mutex mutex_;
    std::size_t most_ = 0, held_for_long_ = 0;
    Clock::time_point last_full_ = {};
    std::map<std::string, Bytes> clients_;
    std::map<std::string, Claim> claims_;
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
