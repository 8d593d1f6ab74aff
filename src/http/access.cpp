#include "http/access.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "api/problem.hpp"
#include "http/header_text.hpp"
#include "http/problem_response.hpp"

namespace vines::http {

namespace {

bool ends_with(std::string_view text, std::string_view ending) {
    return text.size() >= ending.size() && text.substr(text.size() - ending.size()) == ending;
}

/// The host of HOST or HOST:PORT, in lower case; an IPv6 address keeps its brackets.
std::string host_of(std::string_view authority) {
    const std::size_t bracket = authority.rfind(']');
    const std::size_t from = bracket == std::string_view::npos ? 0 : bracket;
    std::string host = lower_case(authority.substr(0, authority.find(':', from)));
    if (host.size() > 1 && host.back() == '.') host.pop_back();
    return host;
}

bool is_address(std::string_view host) {
    std::array<unsigned char, sizeof(in6_addr)> bytes{};
    const bool six = host.size() > 2 && host.front() == '[' && host.back() == ']';
    const std::string text(six ? host.substr(1, host.size() - 2) : host);
    return ::inet_pton(six ? AF_INET6 : AF_INET, text.c_str(), bytes.data()) == 1;
}

/// A page of a stranger is at a name that the stranger has registered, which has a dot in it, and
/// may have it point to this machine. It is at no name of a local network, nor at an address of
/// this machine.
bool is_meant(std::string_view host, const AccessOptions& options) {
    const auto allows = [host](const std::string& name) {
        return name == "*" || lower_case(name) == host;
    };
    return is_loopback(host) || host.find_first_of(".:") == std::string_view::npos ||
           host == host_of(in_url(options.listens_on)) ||
           (!is_loopback(options.listens_on) && is_address(host)) ||
           std::any_of(options.hosts.begin(), options.hosts.end(), allows);
}

/// Without the port that goes without saying: a proxy may have taken the request at another.
std::string authority_of(std::string_view origin) {
    const std::size_t scheme = origin.find("://");
    std::string authority =
        lower_case(scheme == std::string_view::npos ? origin : origin.substr(scheme + 3));
    for (const std::string_view port : {":80", ":443"})
        if (ends_with(authority, port)) authority.resize(authority.size() - port.size());
    return authority;
}

/// Whether a browser says that a page of another origin sends the request.
bool is_foreign(const Head& head) {
    const std::string_view site = head.header("sec-fetch-site");
    if (!site.empty()) return site != "same-origin" && site != "none";
    const std::string_view origin = head.header("origin");
    return !origin.empty() && authority_of(origin) != authority_of(head.host);
}

/// Whether it is for a tab of its own that somebody is led to a place here. In a frame of another
/// page only what says itself who may show it belongs.
bool follows_link(const Head& head, const Route* route) {
    if (head.method == "POST" || head.header("sec-fetch-mode") != "navigate") return false;
    const std::string_view destination = head.header("sec-fetch-dest");
    return destination.empty() || destination == "document" || (route && route->knows_its_frames);
}

/// Whether a request comes from a page that may use the service.
bool shares(const Head& head, const AccessOptions& options) {
    const std::string origin = lower_case(head.header("origin"));
    return !origin.empty() &&
           std::any_of(
               options.origins.begin(), options.origins.end(), [&origin](const auto& allowed) {
                   return allowed == "*" || lower_case(allowed) == origin;
               });
}

Response key_refusal() {
    Response response = problem_response(
        401, "this server asks for a key, in the header \"Authorization: Bearer KEY\"");
    response.headers.emplace_back("WWW-Authenticate", "Bearer realm=\"vines\"");
    return response;
}

}  // namespace

bool is_loopback(std::string_view host) {
    return host == "localhost" || ends_with(host, ".localhost") || host == "[::1]" ||
           host == "::1" || (is_address(host) && host.substr(0, 4) == "127.");
}

std::string in_url(const std::string& address) {
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

std::optional<Response> access_refusal(
    const Head& head, const Route* route, const AccessOptions& options) {
    const std::string host = host_of(head.host);
    if (!host.empty() && !is_meant(host, options)) {
        const std::string shown = api::shortened(host);
        return problem_response(
            421, fmt::format(
                     "this server is not {}: if that is its name, start it with --allow-host {}",
                     shown, shown));
    }
    if (is_foreign(head) && !follows_link(head, route) && !shares(head, options))
        return problem_response(403, "a page of another origin may not use this server");
    if (route && !route->open && options.keys.are_asked_for() &&
        !options.keys.open(head.header("authorization")))
        return key_refusal();
    return std::nullopt;
}

bool is_preflight(const Head& head, const AccessOptions& options) {
    return head.method == "OPTIONS" && head.has("access-control-request-method") &&
           shares(head, options);
}

std::vector<std::pair<std::string, std::string>> sharing_headers(
    const Head& head, const AccessOptions& options) {
    if (options.origins.empty()) return {};
    if (!shares(head, options)) return {{"Vary", "Origin"}};
    std::vector<std::pair<std::string, std::string>> headers = {
        {"Vary", "Origin"},
        {"Access-Control-Allow-Origin", std::string(head.header("origin"))},
        {"Access-Control-Expose-Headers", "ETag, Retry-After, Server-Timing, X-Request-ID"}};
    if (!is_preflight(head, options)) return headers;
    headers.insert(
        headers.end(), {{"Access-Control-Allow-Methods", "GET, HEAD, POST"},
                        {"Access-Control-Allow-Headers",
                         "Authorization, Content-Type, If-None-Match, X-Request-ID, traceparent"},
                        {"Access-Control-Max-Age", "86400"}});
    return headers;
}

}  // namespace vines::http
