// The page's files and those of the documentation, as routes: compiled into the program, or
// read from a folder during development.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "http/message.hpp"

namespace vines::http {

struct Asset {
    /// Path of a page, or below a folder named by a hash of all files: its content never changes.
    std::string_view path;
    std::string_view content;
    std::string_view gzipped;  ///< the content, compressed
};

/// All files; generated at build time from web/ by bundle.mjs.
std::span<const Asset> assets();

struct PageOptions {
    /// Serve the page (all but /docs and /help) from this folder, so that changes need no build;
    /// empty: the compiled-in files.
    std::string web_dir = {};
    /// Origins of pages that may show this one in a frame, such as "https://example.org:8443".
    std::vector<std::string> embed_origins = {};
};

/// The routes of all files. Throws std::runtime_error if the folder cannot be read.
std::vector<Route> page_routes(const PageOptions& options);

}  // namespace vines::http
