#include "http/route.hpp"

#include "api/schema/joined.hpp"

namespace vines::http {

const Route* find_route(
    const std::vector<Route>& routes, std::string_view method, std::string_view path) {
    for (const Route& r : routes)
        if (r.path == path && (r.method == method || (r.method == "GET" && method == "HEAD")))
            return &r;
    return nullptr;
}

std::string methods_at(const std::vector<Route>& routes, std::string_view path) {
    std::vector<std::string> methods;
    for (const Route& r : routes) {
        if (r.path != path) continue;
        methods.push_back(r.method);
        if (r.method == "GET") methods.push_back("HEAD");
    }
    return api::joined(methods);
}

}  // namespace vines::http
