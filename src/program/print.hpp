// What a command says on stdout.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

#include "program/write_fully.hpp"

namespace vines {

/// Thrown where nobody is left who reads what a command writes: it ends without a word.
struct ReaderLeft {};

/// What it ends with then, as a program that SIGPIPE ends: 128 + 13.
inline constexpr int reader_left = 141;

/// Throws ReaderLeft, and std::runtime_error with the reason where it cannot be written.
inline void print(std::string_view text) {
    const int failed = write_fully(STDOUT_FILENO, text);
    if (failed == EPIPE) throw ReaderLeft();
    if (failed != 0)
        throw std::runtime_error(fmt::format("cannot write to stdout: {}", std::strerror(failed)));
}

}  // namespace vines
