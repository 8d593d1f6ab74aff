#include "http/api_keys.hpp"

#include <fmt/format.h>
#include <openssl/crypto.h>

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "http/header_text.hpp"
#include "http/plain_file.hpp"

namespace vines::http {

namespace {

// Some ten thousand keys.
constexpr std::size_t most_bytes_of_keys = 1 << 20;

/// RFC 6750's b64token: what a client's library sends as it is.
bool is_key(std::string_view key) {
    return std::all_of(key.begin(), key.end(), [](char c) {
        return (c >= '0' && c <= '9') || (lower_case(c) >= 'a' && lower_case(c) <= 'z') ||
               std::string_view("-._~+/=").find(c) != std::string_view::npos;
    });
}

}  // namespace

ApiKeys ApiKeys::read(const std::string& path) {
    std::istringstream in(read_plain_file(path, most_bytes_of_keys));
    ApiKeys keys;
    std::size_t number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        line = trimmed(line.substr(0, line.find('\r')));
        if (line.empty() || line[0] == '#') continue;
        if (line.size() < shortest || !is_key(line))
            throw std::runtime_error(fmt::format(
                "{}, line {}: a key has {} or more letters, digits or -._~+/=", path, number,
                shortest));
        keys.keys_.push_back(line);
    }
    if (keys.keys_.empty()) throw std::runtime_error(fmt::format("there is no key in {}", path));
    return keys;
}

bool ApiKeys::open(std::string_view authorization) const {
    const std::string_view scheme = next_part(authorization, ' ');
    const std::string_view shown = trimmed(authorization);
    if (lower_case(scheme) != "bearer") return false;
    bool opens = false;
    for (const std::string& key : keys_)
        opens |=
            key.size() == shown.size() && CRYPTO_memcmp(key.data(), shown.data(), key.size()) == 0;
    return opens;
}

}  // namespace vines::http
