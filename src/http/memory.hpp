// Memory: the budget of requests and answers held for all clients (--memory-limit), and what malloc
// keeps.
#pragma once

#include <cstdlib>  // __GLIBC__

#include <atomic>
#include <cstddef>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace vines::http {

class MemoryBudget {
public:
    explicit MemoryBudget(std::size_t limit) : limit_(limit) {}
    /// True if nothing large should be accepted.
    bool is_full() const { return held_ >= limit_; }
    std::size_t bytes() const { return held_; }
    /// Counts `now` bytes of a client instead of `counted`, which it sets to them.
    void count(std::size_t& counted, std::size_t now) {
        held_ += now - counted;
        counted = now;
    }

private:
    const std::size_t limit_;
    std::atomic<std::size_t> held_ = 0;
};

/// Limits the memory that malloc keeps. Blocks of 4 MiB and more are mapped one by one: glibc's own
/// threshold grows up to 32 MiB with what is freed. Below it each arena keeps enough for one answer
/// of tens of thousands of numbers, because each page requested anew costs a microsecond. There are
/// no more arenas than computing threads.
inline void configure_malloc([[maybe_unused]] int computing) {
#ifdef __GLIBC__
    mallopt(M_MMAP_THRESHOLD, 4 << 20);
    mallopt(M_TRIM_THRESHOLD, 8 << 20);
    mallopt(M_ARENA_MAX, computing);
#endif
}

/// Returns free memory to the system, after large requests and answers.
inline void trim_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace vines::http
