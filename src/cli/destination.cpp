#include "cli/destination.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <charconv>
#include <filesystem>
#include <optional>
#include <string_view>

#include "cli/file_error.hpp"
#include "cli/files.hpp"

namespace vines::cli {

namespace {

constexpr int most_links = 40;  // as the kernel follows

/// The number in a path that stands for an open file of this process.
std::optional<int> open_number(const std::string& path) {
    if (path == "/dev/stdout") return STDOUT_FILENO;
    if (path == "/dev/stderr") return STDERR_FILENO;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
        if (!path.starts_with(folder)) continue;
        int number = -1;
        const char* const end = path.data() + path.size();
        const auto [rest, fault] = std::from_chars(path.data() + folder.size(), end, number);
        if (fault == std::errc() && rest == end && number >= 0) return number;
    }
    return std::nullopt;
}

Destination open_already(const std::string& name, int number) {
    Descriptor copy(::fcntl(number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
    if (!copy) fail_at("write", name);
    return {name, std::move(copy), ""};
}

/// Where a symbolic link leads, one step.
std::string next_of(const std::string& link) {
    const std::filesystem::path to = std::filesystem::read_symlink(link);
    return to.is_absolute() ? to.string()
                            : (std::filesystem::path(link).parent_path() / to).string();
}

Destination opened(const std::string& name, const std::string& path) {
    Descriptor stream(::open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
    if (!stream) fail_at("write", name);
    return {name, std::move(stream), ""};
}

}  // namespace

Destination destination_of(const std::string& path) {
    if (is_standard(path)) return open_already("to stdout", STDOUT_FILENO);
    std::string at = path;
    for (int links = 0;; ++links) {
        if (const auto number = open_number(at)) return open_already(path, *number);
        struct stat entry{};
        const bool is_link = ::lstat(at.c_str(), &entry) == 0 && S_ISLNK(entry.st_mode);
        if (!is_link) break;
        if (links == most_links) fail_at("write", path, ELOOP);
        at = next_of(at);
    }
    struct stat entry{};
    if (::stat(at.c_str(), &entry) != 0) {
        if (errno != ENOENT) fail_at("write", path);
        return {path, Descriptor(), at};
    }
    if (S_ISDIR(entry.st_mode)) fail_at("write", path, EISDIR);
    if (S_ISREG(entry.st_mode)) return {path, Descriptor(), at};
    return opened(path, at);
}

}  // namespace vines::cli
