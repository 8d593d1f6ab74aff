// Which path is answered by what.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "http/message.hpp"

namespace vines::http {

struct Route {
    std::string method = {};  ///< GET (answers HEAD, too) or POST
    std::string path = {};
    std::string name = {};  ///< by which it is counted
    std::function<Response(const Request&)> answer = {};
    std::size_t body_limit = 0;  ///< bytes, where it is larger than the server's own
    /// Small and without any computing: answered however busy the server is.
    bool light = false;
    bool knows_its_frames = false;  ///< says to browsers on whose pages it may be shown in a frame
    bool open = false;              ///< to everyone, also where the service asks for a key
};

/// The route that takes this method at this path; null where none does.
const Route* find_route(
    const std::vector<Route>& routes, std::string_view method, std::string_view path);

/// The methods that a path takes, as the header Allow lists them; empty where there is nothing.
std::string methods_at(const std::vector<Route>& routes, std::string_view path);

}  // namespace vines::http
