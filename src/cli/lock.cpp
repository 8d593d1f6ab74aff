#include "cli/lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <stdexcept>

#include "cli/file_error.hpp"

namespace vines::cli {

namespace {

constexpr mode_t mode_of_new = 0666;  // what umask leaves of it

void lock(int descriptor, const std::string& name) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    throw std::runtime_error(
        fmt::format("{} is being written by another run of vines: wait for its end", name));
}

/// Whether it is still what the path leads to.
bool is_at(int descriptor, const std::string& path) {
    struct stat open{}, there{};
    return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &there) == 0 &&
           open.st_dev == there.st_dev && open.st_ino == there.st_ino;
}

}  // namespace

Descriptor open_locked(const Destination& to, int flags) {
    for (;;) {
        Descriptor file(::open(to.file.c_str(), flags | O_CLOEXEC, mode_of_new));
        if (!file && errno == ENOENT && !(flags & O_CREAT)) return file;
        if (!file) fail_at("write", to.name);
        lock(file.number(), to.name);
        // Who held the lock may have put another file in its place.
        if (is_at(file.number(), to.file)) return file;
    }
}

}  // namespace vines::cli
