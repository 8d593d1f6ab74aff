#include "http/regular_file.hpp"

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

constexpr std::size_t read_size = 1 << 16;

// O_NONBLOCK: opening a pipe does not wait for a writer.
constexpr int to_read = O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC;

[[noreturn]] void cannot_read(const std::filesystem::path& path) {
    throw std::runtime_error(
        fmt::format("cannot read {}: {}", path.string(), std::strerror(errno)));
}

std::string contents(
    const Descriptor& file, const std::filesystem::path& path, std::size_t max_bytes) {
    struct stat entry{};
    if (!file || ::fstat(file.number(), &entry) != 0) cannot_read(path);
    if (!S_ISREG(entry.st_mode))
        throw std::runtime_error(fmt::format("cannot read {}: not a regular file", path.string()));
    std::string text;
    for (std::size_t length = 0;;) {  // its size can be wrong, or grow
        text.resize(length + read_size);
        const ssize_t n = ::read(file.number(), text.data() + length, read_size);
        if (n < 0 && errno != EINTR) cannot_read(path);
        if (n > 0) length += static_cast<std::size_t>(n);
        if (length > max_bytes)
            throw std::runtime_error(
                fmt::format("cannot read {}: it has more than {} bytes", path.string(), max_bytes));
        if (n == 0) {
            text.resize(length);
            return text;
        }
    }
}

}  // namespace

std::string read_regular_file(const std::filesystem::path& path, std::size_t max_bytes) {
    return contents(Descriptor(::open(path.c_str(), to_read)), path, max_bytes);
}

std::string read_regular_file_no_links(const std::filesystem::path& path, std::size_t max_bytes) {
    // Opens one name after the other: renaming a folder meanwhile cannot redirect the path.
    Descriptor folder(::open(path.root_path().c_str(), O_PATH | O_DIRECTORY | O_CLOEXEC));
    for (const std::filesystem::path& name : path.relative_path().parent_path()) {
        if (!folder) cannot_read(path);
        folder = Descriptor(
            ::openat(folder.number(), name.c_str(), O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC));
    }
    if (!folder) cannot_read(path);
    return contents(
        Descriptor(::openat(folder.number(), path.filename().c_str(), to_read | O_NOFOLLOW)), path,
        max_bytes);
}

}  // namespace vines::http
