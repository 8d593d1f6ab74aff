// A file that lines are added to.
#pragma once

#include <string>
#include <string_view>

#include "cli/destination.hpp"
#include "program/descriptor.hpp"

namespace vines::cli {

/// There from the start on, and nobody else's meanwhile. All throw std::runtime_error with the
/// reason.
class GrowingFile {
public:
    explicit GrowingFile(const Destination& file);

    /// What it holds.
    std::string read() const;
    /// Leaves the first bytes of it.
    void cut(std::size_t length);
    /// In one write, so that a run that is killed keeps all of them. What does not fit is not
    /// begun.
    void append(std::string_view lines);
    /// Until it is on the disk.
    void sync();

private:
    const std::string name_;
    const Descriptor file_;
    std::size_t length_ = 0;
};

}  // namespace vines::cli
