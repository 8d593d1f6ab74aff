#include "http/client.hpp"

#include <arpa/inet.h>

#include "program/whole_number.hpp"

namespace vines::http {

namespace {

using Bytes = std::array<unsigned char, 16>;

// Bits before the IPv4 address in an IPv4-mapped IPv6 address.
constexpr int mapped_bits = 96;

constexpr int owner_bits = 64;

bool is_v4(const std::string& text) { return text.find(':') == std::string::npos; }

std::optional<Bytes> bytes_of(const std::string& text) {
    Bytes bytes{};
    int read = 0;
    if (is_v4(text)) {
        bytes[10] = bytes[11] = 0xff;
        read = ::inet_pton(AF_INET, text.c_str(), &bytes[12]);
    } else read = ::inet_pton(AF_INET6, text.c_str(), bytes.data());
    return read == 1 ? std::optional(bytes) : std::nullopt;
}

void clear_after(Bytes& bytes, int bits) {
    for (int i = 0; i < 128; i += 8) {
        const int kept = std::clamp(bits - i, 0, 8);
        bytes[static_cast<std::size_t>(i / 8)] &= static_cast<unsigned char>(0xff00 >> kept);
    }
}

}  // namespace

std::optional<Network> Network::read(std::string_view text) {
    const std::string address(text.substr(0, text.find('/')));
    const std::optional<Bytes> bytes = bytes_of(address);
    const std::size_t most = is_v4(address) ? 32 : 128;
    std::optional<std::size_t> bits = most;
    if (address.size() < text.size()) bits = whole_number(text.substr(address.size() + 1), 0, most);
    if (!bytes || !bits) return std::nullopt;
    Network network;
    network.bytes_ = *bytes;
    network.bits_ = static_cast<int>(*bits) + (is_v4(address) ? mapped_bits : 0);
    clear_after(network.bytes_, network.bits_);
    return network;
}

bool Network::contains(std::string_view address) const {
    std::optional<Bytes> bytes = bytes_of(std::string(address));
    if (!bytes) return false;
    clear_after(*bytes, bits_);
    return *bytes == bytes_;
}

bool contain(const Networks& networks, std::string_view address) {
    return std::ranges::any_of(
        networks, [address](const Network& network) { return network.contains(address); });
}

bool is_address(const std::string& text) { return bytes_of(text).has_value(); }

std::string client_address(const Head& head, const std::string& peer, const Networks& proxies) {
    std::string client = peer;
    std::string_view forwarded = head.header("x-forwarded-for");
    while (!forwarded.empty() && contain(proxies, client)) {
        const std::size_t comma = forwarded.rfind(',');
        const std::size_t begin = comma == std::string_view::npos ? 0 : comma + 1;
        const std::string stated(trimmed(forwarded.substr(begin)));
        if (!is_address(stated)) break;
        client = stated;
        forwarded = forwarded.substr(0, begin == 0 ? 0 : comma);
    }
    return client;
}

std::string owner_of(const std::string& address) {
    static const Network v4 = *Network::read("0.0.0.0/0");
    std::optional<Bytes> bytes = bytes_of(address);
    if (!bytes || v4.contains(address)) return address;
    clear_after(*bytes, owner_bits);
    std::array<char, INET6_ADDRSTRLEN> text{};
    return ::inet_ntop(AF_INET6, bytes->data(), text.data(), text.size());
}

}  // namespace vines::http
