// Memory limits. MemoryBudget counts the bytes of requests and answers held for all clients
// (--memory-limit); each connection accounts for its own with a MemoryShare.
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

private:
    friend class MemoryShare;
    const std::size_t limit_;
    std::atomic<std::size_t> held_ = 0;
};

/// One client's share of the budget, which must outlive it.
class MemoryShare {
public:
    explicit MemoryShare(MemoryBudget& memory) : memory_(memory) {}
    ~MemoryShare() { set(0); }
    MemoryShare(const MemoryShare&) = delete;
    MemoryShare& operator=(const MemoryShare&) = delete;

    void set(std::size_t bytes) {
        memory_.held_ += bytes - bytes_;
        bytes_ = bytes;
    }
    const MemoryBudget& memory() const { return memory_; }

private:
    MemoryBudget& memory_;
    std::size_t bytes_ = 0;
};

/// Returns free memory to the system, after large requests and answers.
inline void trim_memory() {
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

}  // namespace vines::http
