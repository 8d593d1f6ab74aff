#include "cli/temporary_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>

#include <cstdio>
#include <filesystem>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <utility>

#include "cli/files.hpp"

namespace vines::cli {

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

/// Hidden, so that a shell's pattern does not match it. The name does not contain the target's,
/// which can have the maximum length.
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

}  // namespace

TemporaryFile::TemporaryFile(std::string target, std::string name)
    : target_(std::move(target)),
      name_(std::move(name)) {
    struct stat old{};
    const bool replaces = ::stat(target_.c_str(), &old) == 0;
    const std::lock_guard lock(temporaries().mutex);
    do {
        path_ = new_path(target_);
        file_ = Descriptor(::open(
            path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC,
            replaces ? private_mode : new_mode));
    } while (!file_ && errno == EEXIST);
    if (!file_) fail_at("write", name_);
    temporaries().paths.insert(path_);
    if (replaces) copy_owner_and_mode(file_.number(), old);
}

TemporaryFile::~TemporaryFile() {
    const std::lock_guard lock(temporaries().mutex);
    if (path_.empty()) return;
    ::unlink(path_.c_str());
    temporaries().paths.erase(path_);
}

void TemporaryFile::write(std::string_view text) {
    if (const int failed = write_fully(file_.number(), text)) fail_at("write", name_, failed);
}

void TemporaryFile::replace_target() {
    if (::fsync(file_.number()) != 0) fail_at("write", name_);
    {
        const std::lock_guard lock(temporaries().mutex);
        if (::rename(path_.c_str(), target_.c_str()) != 0) fail_at("write", name_);
        temporaries().paths.erase(std::exchange(path_, ""));
    }
    sync_folder(target_);
}

void remove_temporary_files() {
    temporaries().mutex.lock();  // never unlocked
    for (const std::string& path : temporaries().paths) ::unlink(path.c_str());
}

}  // namespace vines::cli
