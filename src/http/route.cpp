#include "http/route.hpp"

namespace vines::http {

const Route* find_route(
    const std::vector<Route>& routes, const std::string& method, const std::string& path) {
    for (const Route& r : routes)
        if (r.path == path && (r.method == method || (r.method == "GET" && method == "HEAD")))
            return &r;
    return nullptr;
}

std::string methods_at(const std::vector<Route>& routes, const std::string& path) {
    std::string list;
    for (const Route& r : routes)
        if (r.path == path)
            list += (list.empty() ? "" : ", ") + r.method + (r.method == "GET" ? ", HEAD" : "");
    return list;
}

}  // namespace vines::http
