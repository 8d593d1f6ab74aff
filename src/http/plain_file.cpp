#include "http/plain_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>

#include "program/descriptor.hpp"

namespace vines::http {

namespace {

constexpr std::size_t piece_of_file = 1 << 16;

// To open a pipe waits for nobody.
constexpr int to_read = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;

[[noreturn]] void cannot_read(const std::filesystem::path& path) {
    throw std::runtime_error(
        fmt::format("cannot read {}: {}", path.string(), std::strerror(errno)));
}

std::string contents(
    const Descriptor& file, const std::filesystem::path& path, std::size_t most_bytes) {
    struct stat entry{};
    if (!file || ::fstat(file.number(), &entry) != 0) cannot_read(path);
    if (!S_ISREG(entry.st_mode))
        throw std::runtime_error(
            fmt::format("cannot read {}: it is no regular file", path.string()));
    std::string text;
    for (std::size_t length = 0;;) {  // it may be longer than it says, or grow
        text.resize(length + piece_of_file);
        const ssize_t n = ::read(file.number(), text.data() + length, piece_of_file);
        if (n < 0 && errno != EINTR) cannot_read(path);
        if (n > 0) length += static_cast<std::size_t>(n);
        if (length > most_bytes)
            throw std::runtime_error(fmt::format(
                "cannot read {}: it has more than {} bytes", path.string(), most_bytes));
        if (n == 0) {
            text.resize(length);
            return text;
        }
    }
}

}  // namespace

std::string read_plain_file(const std::filesystem::path& path, std::size_t most_bytes) {
    return contents(Descriptor(::open(path.c_str(), to_read)), path, most_bytes);
}

std::string read_without_links(const std::filesystem::path& path, std::size_t most_bytes) {
    // One name after the other: what is changed meanwhile leads nowhere else.
    Descriptor folder(::open(path.root_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    for (const std::filesystem::path& name : path.relative_path().parent_path()) {
        if (!folder) cannot_read(path);
        folder = Descriptor(
            ::openat(folder.number(), name.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    }
    if (!folder) cannot_read(path);
    return contents(
        Descriptor(::openat(folder.number(), path.filename().c_str(), to_read | O_NOFOLLOW)), path,
        most_bytes);
}

}  // namespace vines::http
