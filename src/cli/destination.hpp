// Where a path for an answer leads.
#pragma once

#include <string>

#include "program/descriptor.hpp"

namespace vines::cli {

/// Either a stream (stdout, a pipe, a device), which is written to as it is; or a regular file,
/// there or not, which is made anew or grows.
struct Destination {
    std::string name;  ///< in messages
    Descriptor stream;
    std::string file;  ///< its path, symbolic links followed; of a stream ""

    bool is_stream() const { return static_cast<bool>(stream); }
};

/// Of "" and "-": stdout. /dev/stdout, /dev/stderr and /dev/fd/N are what the process has open
/// there. A pipe with a name is waited for until somebody reads it. Throws std::runtime_error with
/// the reason where it leads to a directory or nowhere.
Destination destination_of(const std::string& path);

}  // namespace vines::cli
