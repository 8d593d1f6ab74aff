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

#include "cli/file_error.hpp"

namespace vines::cli {

namespace {

constexpr mode_t new_mode = 0666;  // what umask leaves of it
constexpr mode_t private_mode = 0600;
constexpr mode_t kept_bits = 0777;

/// Those that are there. Held while one comes or goes.
struct Temporaries {
    std::mutex mutex;
    std::set<std::string> paths;
};

/// Never destroyed: a signal may end the program while its objects are.
Temporaries& temporaries() {
    static auto* const all = new Temporaries;
    return *all;
}

std::string folder_of(const std::string& path) {
    const std::string folder = std::filesystem::path(path).parent_path().string();
    return folder.empty() ? "." : folder;
}

/// Hidden, so that no pattern of a shell takes it for one of the user's; of a length of its own,
/// for the target's name may be as long as one can be.
std::string new_path(const std::string& target) {
    std::random_device random;
    return fmt::format("{}/.vines-{:08x}{:08x}", folder_of(target), random(), random());
}

/// Owner, group and mode, as far as this process may.
void make_alike(int file, const struct stat& old) {
    if (::fchown(file, old.st_uid, old.st_gid) != 0)
        (void)!::fchown(file, static_cast<uid_t>(-1), old.st_gid);
    ::fchmod(file, old.st_mode & kept_bits);
}

/// So that the new name outlives a power cut. Some file systems cannot, and then it comes later.
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
    if (replaces) make_alike(file_.number(), old);
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

void TemporaryFile::take_place() {
    if (::fsync(file_.number()) != 0) fail_at("write", name_);
    {
        const std::lock_guard lock(temporaries().mutex);
        if (::rename(path_.c_str(), target_.c_str()) != 0) fail_at("write", name_);
        temporaries().paths.erase(std::exchange(path_, ""));
    }
    sync_folder(target_);
}

void remove_temporary_files() {
    temporaries().mutex.lock();  // for good
    for (const std::string& path : temporaries().paths) ::unlink(path.c_str());
}

}  // namespace vines::cli
