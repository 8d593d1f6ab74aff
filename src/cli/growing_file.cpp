#include "cli/growing_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include "cli/file_error.hpp"
#include "cli/files.hpp"
#include "cli/lock.hpp"

namespace vines::cli {

GrowingFile::GrowingFile(const Destination& file)
    : name_(file.name),
      file_(open_locked(file, O_RDWR | O_CREAT | O_APPEND)) {
    struct stat entry{};
    if (::fstat(file_.number(), &entry) != 0) fail_at("read", name_);
    length_ = static_cast<std::size_t>(entry.st_size);
}

std::string GrowingFile::read() const {
    if (::lseek(file_.number(), 0, SEEK_SET) < 0) fail_at("read", name_);
    return read_open(file_.number(), name_);
}

void GrowingFile::cut(std::size_t length) {
    if (length == length_) return;
    if (::ftruncate(file_.number(), static_cast<off_t>(length)) != 0) fail_at("write", name_);
    length_ = length;
}

void GrowingFile::append(std::string_view lines) {
    const int failed = write_fully(file_.number(), lines);
    if (failed == 0) {
        length_ += lines.size();
        return;
    }
    // Where even that fails, the next run cuts it off.
    (void)!::ftruncate(file_.number(), static_cast<off_t>(length_));
    fail_at("write", name_, failed);
}

void GrowingFile::sync() {
    if (::fsync(file_.number()) != 0) fail_at("write", name_);
}

}  // namespace vines::cli
