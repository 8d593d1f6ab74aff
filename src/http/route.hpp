// Routes: the function that answers a method and path, and checks of a request's head.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "http/head.hpp"
#include "http/message.hpp"

namespace vines::http {

struct Route {
    std::string method = {};  ///< GET (which includes HEAD) or POST
    std::string path = {};
    std::string name = {};  ///< label in the metrics
    std::function<Response(const Request&)> answer = {};
    std::size_t body_limit = 0;  ///< bytes, if larger than the server's limit
    /// Small and without computation: answered by the event loop, however busy the workers are.
    bool on_event_loop = false;
    bool sets_frame_policy = false;  ///< its answers state which pages may show it in a frame
    bool is_public = false;          ///< needs no API key
};

/// The route for a method and path; null if none.
const Route* find_route(
    const std::vector<Route>& routes, std::string_view method, std::string_view path);

/// The methods of a path, as listed in the header Allow; empty if the path is unknown.
std::string allowed_methods(const std::vector<Route>& routes, std::string_view path);

/// Refuses what the head alone shows to be unacceptable, before the body is read; nothing if the
/// request is fine. route: null if no route matches; body_limit: bytes, for routes without their
/// own limit.
std::optional<Response> request_refusal(
    const Head& head, const Route* route, const std::vector<Route>& routes, std::size_t body_limit);

}  // namespace vines::http
