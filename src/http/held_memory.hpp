// The bytes of requests and answers that the service holds for all of its clients.
#pragma once

#include <atomic>
#include <cstddef>

namespace vines::http {

class HeldMemory {
public:
    explicit HeldMemory(std::size_t limit) : limit_(limit) {}
    /// Whether nothing large should be taken on.
    bool is_full() const { return held_ >= limit_; }
    std::size_t bytes() const { return held_; }

private:
    friend class HeldBytes;
    const std::size_t limit_;
    std::atomic<std::size_t> held_ = 0;
};

/// One client's part of it, which outlives this.
class HeldBytes {
public:
    explicit HeldBytes(HeldMemory& memory) : memory_(memory) {}
    ~HeldBytes() { set(0); }
    HeldBytes(const HeldBytes&) = delete;
    HeldBytes& operator=(const HeldBytes&) = delete;

    void set(std::size_t bytes) {
        memory_.held_ += bytes - bytes_;
        bytes_ = bytes;
    }
    const HeldMemory& memory() const { return memory_; }

private:
    HeldMemory& memory_;
    std::size_t bytes_ = 0;
};

}  // namespace vines::http
