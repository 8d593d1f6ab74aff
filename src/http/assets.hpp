// The page's files, compiled into the program.
#pragma once

#include <span>
#include <string_view>

namespace vines::http {

struct Asset {
    /// Of a page, or one in a folder that is named by the content of all files: what it names never
    /// changes.
    std::string_view path;
    std::string_view content;
    std::string_view gzipped;  ///< the same, compressed
};

/// Generated at build from web/ by embed.mjs.
std::span<const Asset> assets();

}  // namespace vines::http
