// The files of the page, and of that of the OpenAPI document, as routes.
#pragma once

#include <string>
#include <vector>

#include "http/route.hpp"

namespace vines::http {

struct PageOptions {
    /// Its scripts, style sheets and drawings as they are in this folder, so that a change shows
    /// without a build; empty: those compiled in.
    std::string web_dir = {};
    /// Of pages that may show it in a frame: "https://example.org:8443", each.
    std::vector<std::string> embed_origins = {};
};

/// Whether a text is an origin: a scheme, http or https, a host and perhaps a port, no more.
bool is_origin(const std::string& text);

/// Throws std::runtime_error where the folder cannot be read.
std::vector<Route> page_routes(const PageOptions& options);

}  // namespace vines::http
