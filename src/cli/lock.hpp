// One writer of a file at a time.
#pragma once

#include "cli/destination.hpp"
#include "program/descriptor.hpp"

namespace vines::cli {

/// Opens a file for writing (flags of open()) and keeps other runs of this program from writing it
/// until it is closed. None where there is no such file and O_CREAT is not among the flags. Throws
/// std::runtime_error at once where another run is at it, or with the reason where it cannot be
/// opened. On a file system that knows no locks there is none.
Descriptor open_locked(const Destination& file, int flags);

}  // namespace vines::cli
