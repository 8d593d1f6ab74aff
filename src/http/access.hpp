// From where the service may be used: a page of another site, in the browser of someone who can
// reach it, must neither read nor use it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "http/api_keys.hpp"
#include "http/head.hpp"
#include "http/route.hpp"

namespace vines::http {

struct AccessOptions {
    std::string listens_on = "127.0.0.1";  ///< the address
    /// Names that a request may be meant for, beside those of this machine's loopback and those
    /// without a dot; "*": any.
    std::vector<std::string> hosts;
    /// Of pages that may use the service, as their browsers say it: https://example.org; "*": all.
    std::vector<std::string> origins;
    ApiKeys keys;
};

/// Problem 421 for a request that is meant for another host, as one of a page that has had its own
/// name resolved to this server's address; 403 for what a page of another origin asks for, unless
/// it may or somebody follows a link there, not in a frame; 401 where a route is not for everyone
/// and no key is shown. route: null where there is none.
std::optional<Response> access_refusal(
    const Head& head, const Route* route, const AccessOptions& options);

/// Whether a browser asks for leave to send a request of a page that may (Fetch, 3.2.2).
bool is_preflight(const Head& head, const AccessOptions& options);

/// What an answer says to the browser of a page of another origin.
std::vector<std::pair<std::string, std::string>> sharing_headers(
    const Head& head, const AccessOptions& options);

/// Whether a name or an address is this machine's own for itself: localhost, 127.0.0.1, [::1].
bool is_loopback(std::string_view host);

/// As it stands in a URL: an IPv6 address in brackets.
std::string in_url(const std::string& address);

}  // namespace vines::http
