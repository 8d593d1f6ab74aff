// File descriptors: their owner, reading and writing to the end, and errors.
#pragma once

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstring>
#include <string>
#include <utility>

namespace vines {

/// Closes the file descriptor in its destructor; -1: empty.
class Descriptor {
public:
    explicit Descriptor(int number = -1) : number_(number) {}
    Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
    Descriptor& operator=(Descriptor&& other) noexcept {
        std::swap(number_, other.number_);
        return *this;
    }
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }

    int number() const { return number_; }
    explicit operator bool() const { return number_ >= 0; }

private:
    int number_;
};

/// Thrown when the reader of the output has closed its end of the pipe. The command then ends
/// without a message, because it is no std::exception, whose text is printed.
struct BrokenPipe {};

/// Exit code after BrokenPipe, the same as for a program ended by SIGPIPE: 128 + 13.
inline constexpr int broken_pipe_code = 141;

/// Throws std::runtime_error such as "cannot write PATH: No space left on device", or BrokenPipe
/// for EPIPE. `reason` is an errno value; the default is valid only directly after the failed call.
[[noreturn]] inline void fail_at(const char* what, std::string_view path, int reason = errno) {
    if (reason == EPIPE) throw BrokenPipe();
    throw std::runtime_error(fmt::format("cannot {} {}: {}", what, path, std::strerror(reason)));
}

/// Waits if a process that shares the descriptor has made it non-blocking. Returns whether a failed
/// read() or write() (errno) can be repeated.
inline bool can_repeat(int descriptor, short event) {
    if (errno != EAGAIN) return errno == EINTR;
    pollfd ready{descriptor, event, 0};
    ::poll(&ready, 1, -1);
    return true;
}

/// Writes the whole text with repeated calls of write(). Returns 0, or errno of the call that
/// failed.
inline int write_fully(int descriptor, std::string_view text) {
    while (!text.empty()) {
        const ssize_t n = ::write(descriptor, text.data(), text.size());
        if (n >= 0) text.remove_prefix(static_cast<std::size_t>(n));
        else if (!can_repeat(descriptor, POLLOUT)) return errno;
    }
    return 0;
}

/// Reads from the current position to the end, or until `text` has more than `most` bytes. Returns
/// 0, or errno of the call that failed.
inline int read_fully(int descriptor, std::string& text, std::size_t most = std::string::npos) {
    constexpr std::size_t piece = 1 << 16;
    struct stat entry{};
    // One byte more than the file, so that read() reaches the end without enlarging the text.
    const bool known = ::fstat(descriptor, &entry) == 0 && S_ISREG(entry.st_mode);
    text.resize(known ? static_cast<std::size_t>(entry.st_size) + 1 : piece);
    std::size_t length = 0;
    while (length <= most) {
        if (length == text.size()) text.resize(2 * length);
        const ssize_t n = ::read(descriptor, text.data() + length, text.size() - length);
        if (n == 0) break;
        if (n > 0) length += static_cast<std::size_t>(n);
        else if (!can_repeat(descriptor, POLLIN)) return errno;
    }
    text.resize(length);
    return 0;
}

// Flags of open() for read_regular(): opening a pipe does not wait for a writer.
inline constexpr int open_regular = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;

/// Content of a regular file: reading a pipe could block forever, and a device might never end.
/// Throws std::runtime_error, which names the file by `path`, if it is not open, cannot be read, is
/// not a regular file or has more than `most` bytes.
inline std::string read_regular(
    const Descriptor& file, const std::string& path, std::size_t most = std::string::npos) {
    struct stat entry{};
    if (!file || ::fstat(file.number(), &entry) != 0) fail_at("read", path);
    if (!S_ISREG(entry.st_mode))
        throw std::runtime_error(fmt::format("cannot read {}: not a regular file", path));
    std::string text;
    const bool may_fit = static_cast<std::size_t>(entry.st_size) <= most;
    const int failed = may_fit ? read_fully(file.number(), text, most) : 0;
    if (failed) fail_at("read", path, failed);
    if (!may_fit || text.size() > most)
        throw std::runtime_error(
            fmt::format("cannot read {}: it has more than {} bytes", path, most));
    return text;
}

}  // namespace vines
