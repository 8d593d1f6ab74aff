// Whose request it is.
#include <doctest/doctest.h>

#include <string>

#include "http/client.hpp"

using namespace vines::http;

namespace {

/// The client of a request from this peer with this X-Forwarded-For.
std::string client_of(const std::string& peer, const std::string& forwarded) {
    const Networks proxies = {*Network::read("10.0.0.0/8"), *Network::read("2001:db8::1")};
    Head head;
    head.headers = {{"x-forwarded-for", forwarded}};
    return client_address(head, peer, proxies);
}

}  // namespace

TEST_CASE("only a trusted proxy names the client") {
    CHECK(client_of("192.0.2.1", "203.0.113.9") == "192.0.2.1");
    CHECK(client_of("10.1.2.3", "203.0.113.9") == "203.0.113.9");
    CHECK(client_of("::ffff:10.1.2.3", "203.0.113.9") == "203.0.113.9");
    CHECK(client_of("2001:db8::1", "203.0.113.9") == "203.0.113.9");
    CHECK(client_of("2001:db8::2", "203.0.113.9") == "2001:db8::2");
}

TEST_CASE("entries before the one of an untrusted address can be forged and do not count") {
    CHECK(client_of("10.1.2.3", "198.51.100.7, 203.0.113.9") == "203.0.113.9");
    CHECK(client_of("10.1.2.3", "198.51.100.7, 203.0.113.9,10.9.9.9") == "203.0.113.9");
    CHECK(client_of("10.1.2.3", "203.0.113.9, unknown") == "10.1.2.3");
    CHECK(client_of("10.1.2.3", "203.0.113.9, cafe") == "10.1.2.3");
    CHECK(client_of("10.1.2.3", "") == "10.1.2.3");
    CHECK(client_of("10.1.2.3", ",") == "10.1.2.3");
}

TEST_CASE("a network is an address with up to as many bits as it has") {
    for (const char* text :
         {"", "10.0.0.0/33", "10.0.0.0/", "10.0.0/8", "::/129", "host", "cafe", "/8"})
        CHECK_FALSE(Network::read(text));
    CHECK(Network::read("0.0.0.0/0")->contains("255.1.2.3"));
    CHECK_FALSE(Network::read("0.0.0.0/0")->contains("2001:db8::1"));
    CHECK(Network::read("10.1.0.0/15")->contains("10.0.255.255"));
    CHECK_FALSE(Network::read("10.2.0.0/15")->contains("10.1.255.255"));
    CHECK(Network::read("::1")->contains("::1"));
}

TEST_CASE("one client has all addresses that begin with the same 64 bits of IPv6") {
    CHECK(owner_of("192.0.2.1") == "192.0.2.1");
    CHECK(owner_of("::ffff:192.0.2.1") == "::ffff:192.0.2.1");
    CHECK(owner_of("2001:db8:1:2:3:4:5:6") == "2001:db8:1:2::");
}
