#include "http/page.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string_view>

#include "http/assets.hpp"

namespace vines::http {

namespace {

// Everything from this server, nothing inline: the page's scripts and styles are files.
const char* const page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src "
    "'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

/// By the file name's ending.
std::string content_type_of(std::string_view path) {
    const std::string_view ending = path.substr(std::min(path.rfind('.'), path.size()));
    if (ending == ".js" || ending == ".mjs") return "text/javascript; charset=utf-8";
    if (ending == ".css") return "text/css; charset=utf-8";
    if (ending == ".svg") return "image/svg+xml";
    return "text/html; charset=utf-8";
}

std::string content_of(const Asset& asset, const std::string& web_dir) {
    if (!web_dir.empty()) {
        const std::string name = asset.path == "/" ? "/index.html" : std::string(asset.path);
        std::ifstream file(web_dir + name, std::ios::binary);
        if (file) return {std::istreambuf_iterator<char>(file), {}};
    }
    return std::string(asset.content);
}

}  // namespace

std::vector<Route> page_routes(const std::string& web_dir) {
    std::vector<Route> routes;
    for (const Asset& asset : assets())
        routes.push_back(
            {.method = "GET",
             .path = std::string(asset.path),
             .answer = [asset, web_dir](const Request&) {
                 return Response{
                     .content_type = content_type_of(asset.path),
                     .body = content_of(asset, web_dir),
                     .headers = {
                         {"Content-Security-Policy", page_policy},
                         {"X-Content-Type-Options", "nosniff"},
                         {"Referrer-Policy", "no-referrer"}}};
             }});
    return routes;
}

}  // namespace vines::http
