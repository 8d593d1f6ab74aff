// A temporary file that replaces another file atomically.
#pragma once

#include <string>
#include <string_view>

#include "program/descriptor.hpp"

namespace vines::cli {

/// Created in the target's folder, with the target's mode if that exists. The destructor removes it
/// unless it has replaced the target; so does remove_temporary_files() when a signal ends the
/// program.
class TemporaryFile {
public:
    /// `name` is used in messages. The constructor and all members throw std::runtime_error with
    /// the reason.
    TemporaryFile(std::string target, std::string name);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::string_view text);
    /// Syncs the file to disk first, so that a power failure leaves the old or the new content.
    void replace_target();

private:
    const std::string target_, name_;
    std::string path_;  ///< empty after it has replaced the target
    Descriptor file_;
};

/// Removes all temporary files and blocks the creation and renaming of others for good. Called by
/// the thread that ends the program after a signal.
void remove_temporary_files();

}  // namespace vines::cli
