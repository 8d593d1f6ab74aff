// From where the service may be used: a page of another site, in the browser of someone who can
// reach it, must neither read nor use it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "http/head.hpp"
#include "http/message.hpp"

namespace vines::http {

struct AccessOptions {
    std::string listens_on = "127.0.0.1";  ///< the address
    /// Names that a request may be meant for, beside those of this machine's loopback and those
    /// without a dot; "*": any.
    std::vector<std::string> hosts;
};

/// Problem 421 for a request that is meant for another host, as one of a page that has had its own
/// name resolved to this server's address; 403 for what a page of another origin
/// asks for, unless somebody follows a link there.
std::optional<Response> access_refusal(const Head& head, const AccessOptions& options);

/// Whether a name or an address is this machine's own for itself: localhost, 127.0.0.1, [::1].
bool is_loopback(std::string_view host);

/// As it stands in a URL: an IPv6 address in brackets.
std::string in_url(const std::string& address);

}  // namespace vines::http
