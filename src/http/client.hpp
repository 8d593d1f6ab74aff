// The client of a request, between which resources are shared fairly: the API key, else the
// address; behind a trusted proxy the address that the proxy states.
#pragma once

#include <array>
#include <optional>

#include "http/head.hpp"

namespace vines::http {

/// A range of addresses: ADDRESS or ADDRESS/BITS, IPv4 or IPv6.
class Network {
public:
    /// Nothing if the text is not one.
    static std::optional<Network> read(std::string_view text);
    bool contains(std::string_view address) const;

private:
    std::array<unsigned char, 16> bytes_{};  // IPv4 as an IPv4-mapped IPv6 address
    int bits_ = 0;
};
using Networks = std::vector<Network>;

bool contain(const Networks& networks, std::string_view address);

bool is_address(const std::string& text);  ///< IPv4 or IPv6

/// The client's address: the peer's, or if that is a trusted proxy the last address in
/// X-Forwarded-For that is not one. An entry that is no address ends the search.
std::string client_address(const Head& head, const std::string& peer, const Networks& proxies);

/// The part of an address that one client has: of IPv6 the first 64 bits.
std::string owner_of(const std::string& address);

struct Sender {
    std::string address = {};
    std::string key = {};  ///< name of the API key, if any
    /// The unit of fairness: whose turn a request takes.
    std::string client() const { return key.empty() ? owner_of(address) : "key " + key; }
};

}  // namespace vines::http
