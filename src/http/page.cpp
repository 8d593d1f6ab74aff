#include "http/page.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>
#include <utility>

#include "api/problem.hpp"
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

Response file_response(std::string_view path, std::string body) {
    return {
        .content_type = content_type_of(path),
        .body = std::move(body),
        .headers = {
            {"Content-Security-Policy", page_policy},
            {"X-Content-Type-Options", "nosniff"},
            {"Referrer-Policy", "no-referrer"}}};
}

std::vector<Route> embedded_routes() {
    std::vector<Route> routes;
    for (const Asset& asset : assets())
        routes.push_back(
            {.method = "GET", .path = std::string(asset.path), .answer = [asset](const Request&) {
                 Response response = file_response(asset.path, std::string(asset.content));
                 response.gzipped = asset.gzipped;
                 response.immutable = asset.path != "/";
                 return response;
             }});
    return routes;
}

/// Of a file as it is whenever it is asked for.
Route file_route(const std::filesystem::path& file, const std::string& path) {
    return {.method = "GET", .path = path, .answer = [file, path](const Request&) {
                std::ifstream in(file, std::ios::binary);
                if (!in) throw api::Problem(404, "there is no " + path);
                return file_response(
                    path == "/" ? "index.html" : path,
                    std::string(std::istreambuf_iterator<char>(in), {}));
            }};
}

std::vector<Route> folder_routes(const std::filesystem::path& folder) {
    std::vector<Route> routes{file_route(folder / "index.html", "/")};
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::filesystem::path ending = entry.path().extension();
        if (ending != ".js" && ending != ".css" && ending != ".svg") continue;
        const std::string name = entry.path().lexically_relative(folder).generic_string();
        routes.push_back(file_route(entry.path(), "/" + name));
    }
    return routes;
}

}  // namespace

std::vector<Route> page_routes(const std::string& web_dir) {
    return web_dir.empty() ? embedded_routes() : folder_routes(web_dir);
}

}  // namespace vines::http
