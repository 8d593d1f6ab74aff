#include "cli/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <random>
#include <set>
#include <stdexcept>
#include <utility>

#include "program/process.hpp"
#include "program/whole_number.hpp"

namespace vines::cli {

bool is_standard(const std::string& path) { return path.empty() || path == "-"; }

bool is_json(const std::string& text) {
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    return first != std::string::npos && text[first] == '{';
}

std::string read_all(const std::string& path) {
    if (!is_standard(path)) return read_file(path);
    if (::isatty(STDIN_FILENO) == 1) print_message("reading from the terminal; Ctrl-D ends it");
    return read_open(STDIN_FILENO, "stdin");
}

std::string read_file(const std::string& path) {
    // A socket cannot be opened by its path.
    if (path == "/dev/stdin") return read_open(STDIN_FILENO, path);
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
    if (!file) fail_at("read", path);
    return read_open(file.number(), path);
}

std::string read_open(int descriptor, const std::string& name) {
    std::string text;
    if (const int failed = read_fully(descriptor, text)) fail_at("read", name, failed);
    return text;
}

namespace {

constexpr mode_t new_mode = 0666;  // reduced by umask
constexpr mode_t private_mode = 0600;
constexpr mode_t kept_bits = 0777;

/// Existing temporary files. The mutex is held while one is created, renamed or removed.
struct Temporaries {
    std::mutex mutex;
    std::set<std::string> paths;
};

/// Never destroyed: a signal can end the program during destruction of its static objects.
Temporaries& temporaries() {
    static auto* const all = new Temporaries;
    return *all;
}

std::string folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

/// A hidden name without the target's, which can have the maximum length.
std::string new_path(const std::string& target) {
    std::random_device random;
    return fmt::format("{}/.vines-{:08x}{:08x}", folder_of(target), random(), random());
}

/// Copies owner, group and mode, as far as this process is permitted to.
void copy_owner_and_mode(int file, const struct stat& old) {
    if (::fchown(file, old.st_uid, old.st_gid) != 0)
        (void)!::fchown(file, static_cast<uid_t>(-1), old.st_gid);
    ::fchmod(file, old.st_mode & kept_bits);
}

/// Makes the new name survive a power failure. Some file systems do not support that.
void sync_folder(const std::string& path) {
    const Descriptor folder(::open(folder_of(path).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (folder) ::fsync(folder.number());
}

constexpr int max_links = 40;  // as in Linux (MAXSYMLINKS)

/// Number of the file descriptor of this process that the path stands for, as /dev/fd/3 does.
std::optional<std::size_t> descriptor_number(const std::string& path) {
    if (path == "/dev/stdout") return STDOUT_FILENO;
    if (path == "/dev/stderr") return STDERR_FILENO;
    for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"})
        if (path.starts_with(folder))
            return whole_number(std::string_view(path).substr(folder.size()), 0, INT_MAX);
    return std::nullopt;
}

Destination open_descriptor(const std::string& name, int number) {
    // The copy is above 2, and closing it leaves the standard streams open.
    Descriptor copy(::fcntl(number, F_DUPFD_CLOEXEC, STDERR_FILENO + 1));
    if (!copy) fail_at("write", name);
    return {name, std::move(copy), ""};
}

void lock(int descriptor, const std::string& name) {
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return;
    throw std::runtime_error(
        fmt::format("another run of vines is writing {}; wait until it ends", name));
}

/// Returns whether the path still leads to this open file.
bool is_still_at(int descriptor, const std::string& path) {
    struct stat open{}, there{};
    return ::fstat(descriptor, &open) == 0 && ::stat(path.c_str(), &there) == 0 &&
           open.st_dev == there.st_dev && open.st_ino == there.st_ino;
}

/// Opens a file for writing (flags of open()) and locks it against other runs of this program until
/// it is closed; throws std::runtime_error if another run holds the lock. Empty if the file is
/// missing and O_CREAT is not set. File systems without locks are written unlocked.
Descriptor open_locked(const Destination& to, int flags) {
    for (;;) {
        Descriptor file(::open(to.file.c_str(), flags | O_CLOEXEC, new_mode));
        if (!file && errno == ENOENT && !(flags & O_CREAT)) return file;
        if (!file) fail_at("write", to.name);
        lock(file.number(), to.name);
        // Retries if the previous holder of the lock has replaced the file.
        if (is_still_at(file.number(), to.file)) return file;
    }
}

}  // namespace

Destination destination_of(const std::string& path) {
    if (is_standard(path)) return open_descriptor("to stdout", STDOUT_FILENO);
    // Follows links one at a time: a link can lead to /dev/fd/N, which realpath() would resolve
    // further, and a missing target can be created.
    std::filesystem::path at = path;
    std::error_code error;
    for (int links = 0;; ++links) {
        if (const auto number = descriptor_number(at.string()))
            return open_descriptor(path, static_cast<int>(*number));
        if (!std::filesystem::is_symlink(at, error)) break;
        if (links == max_links) fail_at("write", path, ELOOP);
        at = at.parent_path() / std::filesystem::read_symlink(at);
    }
    switch (std::filesystem::status(at, error).type()) {
        case std::filesystem::file_type::none: fail_at("write", path, error.value());
        case std::filesystem::file_type::directory: fail_at("write", path, EISDIR);
        case std::filesystem::file_type::not_found:
        case std::filesystem::file_type::regular: return {path, Descriptor(), at.string()};
        default: break;
    }
    Descriptor stream(::open(at.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
    if (!stream) fail_at("write", path);
    return {path, std::move(stream), ""};
}

void remove_temporary_files() {
    temporaries().mutex.lock();  // never unlocked
    for (const std::string& path : temporaries().paths) ::unlink(path.c_str());
}

Output::Output(Destination to, Descriptor lock) : to_(std::move(to)), lock_(std::move(lock)) {
    if (to_.is_stream()) return;
    if (!lock_) lock_ = open_locked(to_, O_WRONLY);
    struct stat old{};
    const bool replaces = ::stat(to_.file.c_str(), &old) == 0;
    const std::lock_guard guard(temporaries().mutex);
    do {
        temporary_ = new_path(to_.file);
        file_ = Descriptor(::open(
            temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
            replaces ? private_mode : new_mode));
    } while (!file_ && errno == EEXIST);
    if (!file_) fail_at("write", to_.name);
    temporaries().paths.insert(temporary_);
    if (replaces) copy_owner_and_mode(file_.number(), old);
}

Output::~Output() {
    if (temporary_.empty()) return;
    const std::lock_guard guard(temporaries().mutex);
    ::unlink(temporary_.c_str());
    temporaries().paths.erase(temporary_);
}

void Output::write(std::string_view text) {
    const int to = to_.is_stream() ? to_.stream.number() : file_.number();
    if (const int failed = write_fully(to, text)) fail_at("write", to_.name, failed);
}

void Output::end() {
    if (to_.is_stream()) return;
    // A power failure leaves the old or the new content.
    if (::fsync(file_.number()) != 0) fail_at("write", to_.name);
    {
        const std::lock_guard guard(temporaries().mutex);
        if (::rename(temporary_.c_str(), to_.file.c_str()) != 0) fail_at("write", to_.name);
        temporaries().paths.erase(std::exchange(temporary_, ""));
    }
    sync_folder(to_.file);
}

void write_all(const std::string& path, const std::string& text) {
    Output out(path);
    out.write(text);
    out.end();
}

AppendFile::AppendFile(const Destination& file)
    : path_(file.file),
      name_(file.name),
      file_(open_locked(file, O_RDWR | O_CREAT | O_APPEND)) {
    struct stat entry{};
    if (::fstat(file_.number(), &entry) != 0) fail_at("read", name_);
    length_ = static_cast<std::size_t>(entry.st_size);
}

std::string AppendFile::read() const {
    if (::lseek(file_.number(), 0, SEEK_SET) < 0) fail_at("read", name_);
    return read_open(file_.number(), name_);
}

void AppendFile::truncate(std::size_t length) {
    if (length == length_) return;
    if (::ftruncate(file_.number(), static_cast<off_t>(length)) != 0) fail_at("write", name_);
    length_ = length;
}

void AppendFile::append(std::string_view lines) {
    const int failed = write_fully(file_.number(), lines);
    if (failed == 0) {
        length_ += lines.size();
        return;
    }
    // If this fails too, the next run removes the incomplete line.
    (void)!::ftruncate(file_.number(), static_cast<off_t>(length_));
    fail_at("write", name_, failed);
}

void AppendFile::sync() {
    if (::fsync(file_.number()) != 0) fail_at("write", name_);
}

void AppendFile::replace(std::string_view content) {
    Output copy({name_, Descriptor(), path_}, std::move(file_));
    copy.write(content);
    copy.end();
}

}  // namespace vines::cli
