#include "http/access.hpp"

#include <openssl/crypto.h>

#include <sstream>

#include "api/provenance.hpp"
#include "program/descriptor.hpp"
#include "program/whole_number.hpp"

namespace vines::http {

namespace {

/// The methods of a path, as listed in the header Allow; empty if the path is unknown.
std::string allowed_methods(const std::vector<Route>& routes, std::string_view path) {
    std::vector<std::string> methods;
    for (const Route& r : routes) {
        if (r.path != path) continue;
        methods.push_back(r.method);
        if (r.method == "GET") methods.push_back("HEAD");
    }
    return api::joined(methods);
}

/// Checks the body's encoding, type and length.
std::optional<Response> body_refusal(const Head& head, std::size_t limit) {
    if (head.has("content-encoding")) return problem_response(415, "send the body uncompressed");
    if (media_type(head.header("content-type")).starts_with("multipart/"))
        return problem_response(
            415, "send the JSON object as the body itself, not as multipart/form-data");
    if (head.method == "POST" && !head.has("content-length"))
        return problem_response(411, "send a body with its Content-Length");
    if (head.method != "POST" && head.content_length > 0)
        return problem_response(400, fmt::format("a {} has no body", head.method));
    if (head.content_length > limit)
        return problem_response(413, fmt::format("the body is larger than {} bytes", limit));
    return std::nullopt;
}

/// The refusal of a head that is unacceptable from any client. route: null if no route matches.
std::optional<Response> request_refusal(
    const Head& head, const Route* route, const std::vector<Route>& routes,
    std::size_t body_limit) {
    // 200 overlapping ranges would be 200 answers.
    if (head.has("range"))
        return problem_response(
            416, "this service does not send parts of an answer; leave out the Range header");
    if (!route) {
        const std::string path = api::shortened(head.path());
        const std::string methods = allowed_methods(routes, head.path());
        if (methods.empty())
            return problem_response(404, fmt::format("there is nothing at {}", path));
        return problem_response(
            405, fmt::format("{} takes {}, not {}", path, methods, api::shortened(head.method)),
            {{"Allow", methods}});
    }
    return body_refusal(head, std::max(body_limit, route->body_limit));
}

// About ten thousand keys.
constexpr std::size_t max_key_file_size = 1 << 20;

constexpr std::string_view key_characters = "-._~+/=";  // and letters and digits (RFC 6750)

/// Length of the host in HOST or HOST:PORT, with the brackets of an IPv6 address.
std::size_t host_length(std::string_view authority) {
    const std::size_t bracket = authority.rfind(']');
    const std::size_t from = bracket == std::string_view::npos ? 0 : bracket;
    return std::min(authority.find(':', from), authority.size());
}

/// The host of HOST or HOST:PORT, in lower case; an IPv6 address keeps its brackets.
std::string host_of(std::string_view authority) {
    std::string host = lower_case(authority.substr(0, host_length(authority)));
    if (host.size() > 1 && host.back() == '.') host.pop_back();
    return host;
}

/// True for an IPv4 address, or an IPv6 address in brackets.
bool is_address_host(std::string_view host) {
    const bool six = host.size() > 2 && host.front() == '[' && host.back() == ']';
    const std::string text(six ? host.substr(1, host.size() - 2) : host);
    return six == (text.find(':') != std::string::npos) && is_address(text);
}

/// True for a host name (RFC 1123) whose last label is not a number, which would be an address.
bool is_name(const std::string& host) {
    const std::vector<std::string> labels = api::split(host, '.');
    const auto is_label = [](const std::string& label) {
        return !label.empty() && consists_of(label, "-") && label.front() != '-' &&
               label.back() != '-';
    };
    return !labels.empty() && std::ranges::all_of(labels, is_label) && !whole_number(labels.back());
}

/// True for localhost, names below it, and loopback addresses: 127.0.0.1, [::1].
bool is_loopback(std::string_view host) {
    return host == "localhost" || host.ends_with(".localhost") || host == "[::1]" ||
           host == "::1" || (is_address_host(host) && host.starts_with("127."));
}

/// DNS rebinding: an attacker's page has a host name with a dot, registered by the attacker, who
/// can make it resolve to this machine. Names without a dot and addresses of this machine are
/// therefore safe.
bool is_allowed_host(std::string_view host, const AccessOptions& options) {
    const auto allows = [host](const std::string& name) {
        return name == "*" || lower_case(name) == host;
    };
    return is_loopback(host) || host.find_first_of(".:") == std::string_view::npos ||
           host == host_of(in_url(options.host)) ||
           (!is_loopback(options.host) && is_address_host(host)) ||
           std::ranges::any_of(options.hosts, allows);
}

/// Host and port of an origin, without a default port: a proxy may listen on another one.
std::string authority_of(std::string_view origin) {
    const std::size_t scheme = origin.find("://");
    std::string authority =
        lower_case(scheme == std::string_view::npos ? origin : origin.substr(scheme + 3));
    for (const std::string_view port : {":80", ":443"})
        if (authority.ends_with(port)) authority.erase(authority.size() - port.size());
    return authority;
}

/// True if the browser marks the request as sent by a page of another origin.
bool is_cross_origin(const Head& head) {
    const std::string_view site = head.header("sec-fetch-site");
    if (!site.empty()) return site != "same-origin" && site != "none";
    const std::string_view origin = head.header("origin");
    return !origin.empty() && authority_of(origin) != authority_of(head.host);
}

/// True for a link that opens in a tab, or in a frame if the route sets a frame policy.
bool follows_link(const Head& head, const Route* route) {
    if (head.method == "POST" || head.header("sec-fetch-mode") != "navigate") return false;
    const std::string_view destination = head.header("sec-fetch-dest");
    return destination.empty() || destination == "document" || (route && route->sets_frame_policy);
}

bool is_allowed_origin(const Head& head, const AccessOptions& options) {
    const std::string origin = lower_case(head.header("origin"));
    return !origin.empty() && std::ranges::any_of(options.origins, [&origin](const auto& allowed) {
        return allowed == "*" || lower_case(allowed) == origin;
    });
}

/// The refusal by host name, origin or key.
std::optional<Response> access_refusal(
    const Head& head, const Route* route, std::string_view key, const AccessOptions& options) {
    const std::string host = host_of(head.host);
    if (!host.empty() && !is_allowed_host(host, options)) {
        const std::string shown = api::shortened(host);
        return problem_response(
            421, fmt::format(
                     "this server does not answer for {}; to allow it, start the server with "
                     "--allow-host {}",
                     shown, shown));
    }
    if (is_cross_origin(head) && !follows_link(head, route) && !is_allowed_origin(head, options))
        return problem_response(403, "pages of other origins may not use this server");
    if (route && !route->is_public && options.keys && key.empty())
        return problem_response(
            401, "this server requires an API key, in the header \"Authorization: Bearer KEY\"",
            {{"WWW-Authenticate", "Bearer realm=\"vines\""}});
    return std::nullopt;
}

/// True for a CORS preflight of an allowed origin (Fetch, 3.2.2).
bool is_preflight(const Head& head, const AccessOptions& options) {
    return head.method == "OPTIONS" && head.has("access-control-request-method") &&
           is_allowed_origin(head, options);
}

}  // namespace

const Route* find_route(
    const std::vector<Route>& routes, std::string_view method, std::string_view path) {
    for (const Route& r : routes)
        if (r.path == path && (r.method == method || (r.method == "GET" && method == "HEAD")))
            return &r;
    return nullptr;
}

std::size_t ApiKeys::reload() {
    std::istringstream in(
        read_regular(Descriptor(::open(path_.c_str(), open_regular)), path_, max_key_file_size));
    std::vector<Key> keys;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        line = trimmed(line.substr(0, line.find('\r')));
        if (line.empty() || line[0] == '#') continue;
        if (line.size() < min_length || !consists_of(line, key_characters))
            throw std::runtime_error(fmt::format(
                "{}, line {}: a key must have {} or more characters: letters, digits or {}", path_,
                number, min_length, key_characters));
        keys.push_back({line, api::sha256(line).substr(0, 8)});
    }
    if (keys.empty()) throw std::runtime_error(fmt::format("{} contains no key", path_));
    const std::lock_guard lock(mutex_);
    keys_ = std::make_shared<const std::vector<Key>>(std::move(keys));
    return keys_->size();
}

std::string ApiKeys::name_of(std::string_view authorization) const {
    const std::string_view scheme = next_part(authorization, ' ');
    const std::string_view shown = trimmed(authorization);
    if (lower_case(scheme) != "bearer") return {};
    std::string name;
    std::unique_lock lock(mutex_);
    const auto keys = keys_;
    lock.unlock();
    for (const auto& [secret, its_name] : *keys)
        if (secret.size() == shown.size() &&
            CRYPTO_memcmp(secret.data(), shown.data(), secret.size()) == 0)
            name = its_name;
    return name;
}

bool is_origin(std::string_view text) {
    if (!text.starts_with("http://") && !text.starts_with("https://")) return false;
    const std::string_view authority = text.substr(text.find("//") + 2),
                           port = authority.substr(host_length(authority));
    const std::string host = host_of(authority);
    return (is_address_host(host) || is_name(host)) &&
           (port.empty() || whole_number(port.substr(1), 1, 65535));
}

std::string in_url(const std::string& address) {
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

void check_head(
    Request& request, const std::string& peer, const std::vector<Route>& routes,
    const AccessOptions& options) {
    // Its content is in its headers.
    static const Route preflight = {
        .name = "preflight",
        .answer = [](Request&) { return Response{.body = "{}\n"}; },
        .on_event_loop = true};
    const Head& head = request.head;
    Sender& sender = request.sender;
    sender.address = client_address(head, peer, options.proxies);
    if (options.keys) sender.key = options.keys->name_of(head.header("authorization"));
    request.route = find_route(routes, head.method, head.path());
    request.refused = access_refusal(head, request.route, sender.key, options);
    if (request.refused) return;
    if (is_preflight(head, options)) request.route = &preflight;
    request.refused = request_refusal(head, request.route, routes, options.payload_limit);
}

std::vector<Header> cors_headers(const Head& head, const AccessOptions& options) {
    if (options.origins.empty()) return {};
    if (!is_allowed_origin(head, options)) return {{"Vary", "Origin"}};
    std::vector<Header> headers = {
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
