// How much of a request is read, and how long.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>

#include "api/broken_off.hpp"

namespace vines::api {

/// What bounds the reading of a request. Nothing does on the command line: a file there is the
/// user's own.
struct Reading {
    static constexpr std::size_t any_number = std::numeric_limits<std::size_t>::max();

    /// Asked every few thousand steps; once it says true: BrokenOff.
    std::function<bool()> gives_up = {};
    /// Of a record, or of all else that is no array, object or text of their own: each is kept in 8
    /// to 24 bytes. Problem 413 beyond.
    std::size_t most_numbers = any_number;
    /// Numbers and texts in the fields beside a record or a list of impacts. Problem 413 beyond.
    std::size_t most_beside = any_number;
    /// Arrays, objects and names in them, each of which is kept in about 100 bytes. Problem 413
    /// beyond.
    std::size_t most_parts = any_number;

    /// For one pass through a text.
    StillWanted wanted() const { return StillWanted(gives_up, StillWanted::between_looks); }
};

}  // namespace vines::api
