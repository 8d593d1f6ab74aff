// The page's files, compiled into the program.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace vines::http {

struct Asset {
    std::string_view path;  ///< as requested: "/", "/main.js", ...
    std::string_view content;
};

/// Generated at build from web/ by embed.cmake.
std::span<const Asset> assets();

/// By the file name's ending.
std::string_view content_type_of(std::string_view path);

}  // namespace vines::http
