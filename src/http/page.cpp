#include "http/page.hpp"

#include <fcntl.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "program/descriptor.hpp"

namespace vines::http {

namespace {

/// Content security policy: scripts, styles and connections from this server only, and no inline
/// code; images can also be data: URLs.
std::string policy_of(const std::vector<std::string>& embed_origins) {
    std::string policy =
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; "
        "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors";
    if (embed_origins.empty()) policy += " 'none'";
    for (const std::string& origin : embed_origins) policy += " " + origin;
    return policy;
}

/// Content type by the extension of the request path; the paths of pages have none.
std::string content_type_of(std::string_view path) {
    const std::string_view ending = path.substr(std::min(path.rfind('.'), path.size()));
    if (ending == ".js") return "text/javascript; charset=utf-8";
    if (ending == ".css") return "text/css; charset=utf-8";
    if (ending == ".svg") return "image/svg+xml";
    return "text/html; charset=utf-8";
}

Response file_response(std::string_view path, std::string body, const std::string& policy) {
    return {
        .content_type = content_type_of(path),
        .body = std::move(body),
        .headers = {{"Content-Security-Policy", policy}, {"Referrer-Policy", "no-referrer"}}};
}

bool is_page(std::string_view path) { return path.find('.') == path.npos; }

std::vector<Route> embedded_routes(const std::string& policy) {
    std::vector<Route> routes;
    for (const Asset& asset : assets())
        routes.push_back(
            {.method = "GET", .path = std::string(asset.path), .answer = [asset, policy](Request&) {
                 Response response = file_response(asset.path, std::string(asset.content), policy);
                 response.gzipped = asset.gzipped;
                 response.immutable = !is_page(asset.path);
                 return response;
             }});
    return routes;
}

/// Opens a file without following symbolic links in any part of its absolute path: a link could
/// lead out of the folder. Opens one name after the other, so that renaming a folder meanwhile
/// cannot redirect the path.
Descriptor open_without_links(const std::filesystem::path& path) {
    constexpr int to_folder = O_PATH | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
    Descriptor folder(::open(path.root_path().c_str(), to_folder));
    for (const std::filesystem::path& name : path.relative_path().parent_path())
        folder = Descriptor(::openat(folder.number(), name.c_str(), to_folder));
    return Descriptor(
        ::openat(folder.number(), path.filename().c_str(), open_regular | O_NOFOLLOW));
}

/// Reads the file at each request.
Route file_route(
    const std::filesystem::path& file, const std::string& path, const std::string& policy) {
    return {.method = "GET", .path = path, .answer = [=](Request&) {
                try {
                    return file_response(
                        path, read_regular(open_without_links(file), file), policy);
                } catch (const std::runtime_error&) {
                    return problem_response(404, "there is no " + path);
                }
            }};
}

/// True for a script, style sheet or drawing; no other file is served.
bool is_page_asset(const std::filesystem::path& name) {
    const std::filesystem::path ending = name.extension();
    return ending == ".js" || ending == ".css" || ending == ".svg";
}

/// Lists the files once, at start-up; their contents are read at each request. The build makes
/// /docs and /help, which are compiled in with their files.
std::vector<Route> folder_routes(const std::filesystem::path& given, const std::string& policy) {
    std::vector<Route> routes = embedded_routes(policy);
    std::erase_if(routes, [](const Route& route) { return route.path == "/"; });
    try {
        const std::filesystem::path folder = std::filesystem::canonical(given);
        routes.push_back(file_route(folder / "index.html", "/", policy));
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            const std::filesystem::path name = entry.path().lexically_relative(folder);
            if (is_page_asset(name) && std::filesystem::is_regular_file(entry.symlink_status()))
                routes.push_back(file_route(entry.path(), "/" + name.generic_string(), policy));
        }
    } catch (const std::filesystem::filesystem_error& e) {
        throw std::runtime_error(
            fmt::format("cannot read {}: {}", given.string(), e.code().message()));
    }
    return routes;
}

}  // namespace

std::vector<Route> page_routes(const PageOptions& options) {
    const std::string policy = policy_of(options.embed_origins);
    return options.web_dir.empty() ? embedded_routes(policy)
                                   : folder_routes(options.web_dir, policy);
}

}  // namespace vines::http
