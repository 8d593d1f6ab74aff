// Memory: the budget of requests and answers held for clients (--memory-limit); malloc's limits.
#pragma once

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <fstream>
#include <map>
#include <mutex>
#include <string>
#include <utility>

namespace vines::http {

// Longest wait for memory: while it is scarce answers must be read in 30 s.
inline constexpr std::chrono::seconds longest_wait_for_memory(35);

/// Thread-safe.
class MemoryBudget {
public:
    using Clock = std::chrono::steady_clock;

    explicit MemoryBudget(std::size_t limit) : limit_(limit) {}
    /// True if nothing large should be accepted.
    bool is_full() const { return held_ >= limit_; }
    struct Bytes {
        std::size_t all = 0, for_long = 0;  ///< for_long: of these, held while more is computed
    };
    struct Counted {
        std::string client;
        Bytes bytes;
    };
    /// True if `more` bytes should not be accepted of a client. A client's share is the limit
    /// divided by one more than the clients that wait or hold a 4096th of it. Four times what the
    /// client then holds stays free, at most an eighth of the limit, for those who hold less;
    /// beyond its share and a 32nd also two shares, or as much as the client holds, and what others
    /// wait for. More than a quarter of the limit counts as a quarter. Bytes held for long have
    /// half of the budget, of which a client leaves as much free as it holds, and four times what
    /// it then holds up to a 32nd of the limit.
    bool is_full_for(const std::string& client, Bytes more) {
        const std::lock_guard lock(mutex_);
        return is_lacking(client, more, due(client, more, Clock::now()));
    }
    /// The same before the bytes are made, of a client that holds less than half of them, or with
    /// them up to a 32nd, and has waited since this time; false for any other. It then has a claim
    /// for 3 s; one to bytes for long concerns others that hold as many of these, or more. Claims
    /// are due in the order of time, later by the longest wait times the part of the limit that the
    /// client would hold.
    bool must_wait(const std::string& client, Bytes more, Clock::time_point since) {
        const std::lock_guard lock(mutex_);
        const std::size_t held = bytes_of(client).all;
        if (2 * held >= more.all && held + more.all > limit_ / 32) return false;
        const Clock::time_point now = Clock::now(), own = due(client, more, since);
        std::erase_if(claims_, [&](const auto& claim) { return claim.second.until < now; });
        if (claims_[client].bytes.all <= more.all)
            claims_[client] = {more, own, now + std::chrono::seconds(3)};
        return is_lacking(client, more, own);
    }
    /// Counts these bytes instead of what was counted, unless what they add would have to wait, of
    /// who has waited since this time.
    bool reserve(
        Counted& counted, const std::string& client, Bytes bytes, Clock::time_point since) {
        const std::lock_guard lock(mutex_);
        const auto [all, for_long] = counted.bytes;
        const Bytes more{
            bytes.all - std::min(bytes.all, all),
            bytes.for_long - std::min(bytes.for_long, for_long)};
        if ((more.all > 0 || more.for_long > 0) &&
            is_lacking(client, more, due(client, more, since)))
            return false;
        change(counted, client, bytes);
        return true;
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

    /// Counts these bytes of a client instead of what was counted.
    void count(Counted& counted, const std::string& client, Bytes bytes) {
        const std::lock_guard lock(mutex_);
        change(counted, client, bytes);
    }

private:
    struct Claim {
        Bytes bytes;
        Clock::time_point due, until;
    };
    Bytes bytes_of(const std::string& client) const {
        const auto found = clients_.find(client);
        return found == clients_.end() ? Bytes() : found->second;
    }
    Clock::time_point due(const std::string& client, Bytes more, Clock::time_point since) const {
        const auto all = static_cast<double>(bytes_of(client).all + more.all);
        const auto later = longest_wait_for_memory * all / static_cast<double>(limit_);
        return since + std::chrono::duration_cast<Clock::duration>(later);
    }
    bool is_lacking(const std::string& client, Bytes more, Clock::time_point due) {
        const Bytes own = bytes_of(client);
        std::size_t sharing = 2;  // the client and one that could come
        Bytes claimed;
        for (const auto& [other, its] : clients_)
            sharing += other != client && its.all > limit_ / least_part;
        for (const auto& [other, its] : claims_) {
            if (other == client || its.until < Clock::now()) continue;
            sharing += bytes_of(other).all <= limit_ / least_part;
            if (its.due >= due) continue;
            if (bytes_of(other).for_long <= own.for_long) claimed.for_long += its.bytes.for_long;
            if (its.bytes.for_long + more.for_long == 0)
                claimed.all += std::min(its.bytes.all, limit_ / 4);
        }
        const std::size_t needed = std::min(more.all, limit_ / 4), share = limit_ / sharing;
        const std::size_t total = own.all + needed,
                          beyond = std::max(own.all, 2 * share) + claimed.all;
        const std::size_t kept =
            std::min(4 * total, limit_ / 8) + (total <= std::max(share, limit_ / 32) ? 0 : beyond);
        const std::size_t kept_for_long =
            std::max(own.for_long, std::min(4 * (own.for_long + more.for_long), limit_ / 32));
        const bool is_full_now =
            needed + held_ + kept >= limit_ ||
            (more.for_long > 0 &&
             kept_for_long + claimed.for_long + more.for_long + held_for_long_ > limit_ / 2);
        if (is_full() || (is_full_now && own.all < share)) last_full_ = Clock::now();
        return is_full_now;
    }
    void change(Counted& counted, const std::string& client, Bytes bytes) {
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
        if (claim != claims_.end() && claim->second.bytes.all <= 2 * bytes.all)
            claims_.erase(claim);
        counted = {client, bytes};
    }

    static constexpr std::size_t least_part = 4096;

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
inline void configure_malloc(int computing) {
    mallopt(M_MMAP_THRESHOLD, 1 << 20);
    mallopt(M_TRIM_THRESHOLD, 8 << 20);
    mallopt(M_ARENA_MAX, computing);
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
inline void trim_memory() { malloc_trim(0); }

}  // namespace vines::http
