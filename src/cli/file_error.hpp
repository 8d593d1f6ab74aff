// What is said of a file that cannot be read or written.
#pragma once

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string>

#include "program/print.hpp"

namespace vines::cli {

/// "cannot write PATH: No space left on device". `reason` is errno's: call it next after what
/// failed, or hand over what was kept of it. Throws ReaderLeft where a reader has.
[[noreturn]] inline void fail_at(const char* what, const std::string& path, int reason = errno) {
    if (reason == EPIPE) throw ReaderLeft();
    throw std::runtime_error(fmt::format("cannot {} {}: {}", what, path, std::strerror(reason)));
}

}  // namespace vines::cli
