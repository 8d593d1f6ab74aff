// A file that is not yet what it is to become.
#pragma once

#include <string>
#include <string_view>

#include "program/descriptor.hpp"

namespace vines::cli {

/// Beside the file whose place it takes, under a name of its own, with that one's mode. Removed
/// unless it has taken the place: also by a signal that ends the program.
class TemporaryFile {
public:
    /// `name` in messages. Throws std::runtime_error with the reason where none can be made, as the
    /// others do.
    TemporaryFile(std::string target, std::string name);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::string_view text);
    /// On the disk first, so that a power cut leaves the old text or the new.
    void take_place();

private:
    const std::string target_, name_;
    std::string path_;  ///< "" once it is gone
    Descriptor file_;
};

/// From the thread that ends the program at a signal: none is left, and none comes or takes its
/// place any more.
void remove_temporary_files();

}  // namespace vines::cli
