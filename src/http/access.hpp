// Decisions by a request's head, before its body is read: its route, and whether it is acceptable.
// Access control: API keys, the host a request names, and the origin of the page that sends it.
// Any web page can make its visitor's browser send requests to this server. The checks here keep
// pages of other sites from reading answers or starting computations.
#pragma once

#include <memory>
#include <mutex>

#include "http/message.hpp"

namespace vines::http {

/// The route for a method and path; null if none.
const Route* find_route(
    const std::vector<Route>& routes, std::string_view method, std::string_view path);

/// The keys of a file, one per line; empty lines and lines that start with # are skipped.
class ApiKeys {
public:
    /// Reads the file. Throws std::runtime_error if it cannot be read, is not a regular file, is
    /// larger than 1 MiB, contains no key, or a key that is too short or holds characters that a
    /// header cannot.
    explicit ApiKeys(std::string path) : path_(std::move(path)) { reload(); }
    /// Reads the file again, from any thread; returns the number of keys. Throws like the
    /// constructor; the keys are then unchanged.
    std::size_t reload();

    /// The name of the key in the value of Authorization, "Bearer KEY" (RFC 6750): the first 8 hex
    /// digits of its SHA-256, which do not reveal it. Empty if it is none of these keys. The time
    /// it takes does not depend on how many characters of a key match.
    std::string name_of(std::string_view authorization) const;

    static constexpr std::size_t min_length = 16;

private:
    struct Key {
        std::string secret, name;
    };

    const std::string path_;
    mutable std::mutex mutex_;
    std::shared_ptr<const std::vector<Key>> keys_;
};

struct AccessOptions {
    std::string host = "127.0.0.1";  ///< address to listen on
    /// Host names accepted in addition to loopback names and names without a dot; "*": any.
    std::vector<std::string> hosts;
    /// Origins whose pages may use the service, such as https://example.org; "*": all.
    std::vector<std::string> origins;
    std::shared_ptr<const ApiKeys> keys;  ///< null: requests need none
    Networks proxies;                     ///< whose X-Forwarded-For is believed
    std::size_t payload_limit = 1 << 20;  ///< largest body of a route without its own limit, bytes
};

/// Sets the sender of a request, its route and, if its head is unacceptable, its refusal: problem
/// 421 for a host name that is not this server's, as in DNS rebinding; 403 for a cross-origin
/// request, unless its origin is allowed or it follows a link (but not into a frame); 401 for a
/// route that needs a key, without a valid one; others for what is unacceptable from any client.
/// peer: the other end's address. The routes must outlive the request.
void check_head(
    Request& request, const std::string& peer, const std::vector<Route>& routes,
    const AccessOptions& options);

std::vector<Header> cors_headers(const Head& head, const AccessOptions& options);

/// True for http:// or https://, a host (a name, an IPv4 address, or an IPv6 address in brackets)
/// and optionally a port from 1 to 65535.
bool is_origin(std::string_view text);

/// The address as written in a URL: IPv6 in brackets.
std::string in_url(const std::string& address);

}  // namespace vines::http
