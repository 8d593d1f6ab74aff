// The page's files, compiled into the program.
#pragma once

#include <span>
#include <string_view>

namespace vines::http {

struct Asset {
    std::string_view path;  ///< as requested: "/", "/main.js", ...
    std::string_view content;
};

/// Generated at build from web/ by embed.cmake.
std::span<const Asset> assets();

}  // namespace vines::http
