#include <doctest/doctest.h>

#include "http/encoding.hpp"

#include <algorithm>
#include <set>
#include <string>

using namespace vines::http;

TEST_CASE("an ETag differs for bodies of the same length and for longer ones") {
    const std::string body = "{\"tau\":[0.0,0.19634954084936207,0.39269908169872414]}\n";
    std::set<std::string> tags = {entity_tag(body), entity_tag(body + '\0'), entity_tag("")};
    for (std::size_t at = 0; at < body.size(); ++at)
        for (const char c : {' ', '\0', '\xff'}) {
            std::string other = body;
            other[at] = c;
            tags.insert(entity_tag(other));
        }
    CHECK(tags.size() == 3 + 3 * body.size());
    CHECK(entity_tag(body) == entity_tag(std::string(body)));
}

TEST_CASE("a long text is compressed in pieces, and compression stops when it is given up") {
    std::string text;
    for (int k = 0; text.size() < 3 << 20; ++k) text += std::to_string(k * 31 % 7919) + ",";
    text += "and a little more";
    int polls = 0;
    const auto never = [&polls] { return ++polls < 0; };
    CHECK(gzip(text, never) == gzip(text));
    CHECK(polls == 4);
    CHECK_FALSE(gzip(text, [&polls] { return ++polls == 7; }));
    CHECK(polls == 7);
}

TEST_CASE("an answer whose compression is given up is sent as it is") {
    Request request;
    request.head.headers = {{"accept-encoding", "gzip"}};
    for (const bool gives_up : {false, true}) {
        Response response{.body = std::string(1 << 20, '0')};
        CHECK(compress(response, request, [=] { return gives_up; }) == !gives_up);
        complete(request, response);
        CHECK((response.body.size() == 1 << 20) == gives_up);
        CHECK(
            std::ranges::count(response.headers, Header{"Content-Encoding", "gzip"}) == !gives_up);
    }
}

TEST_CASE("gzip is accepted if it is listed with a weight above 0, or everything is") {
    for (const char* header :
         {"gzip", "GZIP", "x-gzip", "br, gzip", "gzip;q=0.5", "gzip ; q=0.001", "gzip;Q=1.000",
          "br;q=1.0, gzip;q=0.8, *;q=0.1", "*", "*;q=0.5", "identity;q=0.5, gzip",
          "deflate,\tgzip ,br"}) {
        CAPTURE(header);
        CHECK(accepts_gzip(header));
    }
}

TEST_CASE("gzip is not accepted if it is not listed, or has the weight 0") {
    for (const char* header :
         {"", "identity", "br, deflate", "gzip;q=0", "gzip;q=0.0", "gzip; q=0.000", "br, gzip;q=0",
          "gzip;q=0, *", "*;q=0", "gzip;q=much", "identity, gzip;q=0.5", "gzipped", "not-gzip"}) {
        CAPTURE(header);
        CHECK_FALSE(accepts_gzip(header));
    }
}

TEST_CASE("compression in pieces gives the same bytes as compression at once") {
    std::string text;
    for (int k = 0; k < 300000; ++k) text += std::to_string(k % 9973 * 7919 % 9973) + ",";
    REQUIRE(text.size() > (1 << 20));
    Gzip pieces;
    std::string zipped;
    for (std::size_t at = 0; at < text.size(); at += 16384)
        zipped += pieces.add(std::string_view(text).substr(at, 16384));
    zipped += pieces.add({}, true);
    CHECK(zipped == gzip(text));
    CHECK(zipped.size() < text.size() / 2);
}
