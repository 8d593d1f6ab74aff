// What the routes answer, without a socket.
#include <doctest/doctest.h>

#include <string>

#include "api/schema/json.hpp"
#include "http/routes.hpp"

using namespace vines::http;
using vines::api::Json;

namespace {

Response answer_of(
    ComputeGate& gate, const RouteOptions& options, const std::string& method,
    const std::string& path) {
    const std::vector<Route> routes = make_routes(options, gate);
    const Route* route = find_route(routes, method, path);
    REQUIRE(route);
    return route->answer(
        {.method = method, .path = path, .query = {}, .content_type = {}, .body = "{}"});
}

bool warns_of(const Json& answer, const std::string& text) {
    return answer["warnings"].dump().find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("simulations and manifolds are turned away where the queue for computing is full") {
    ComputeGate gate({.running = 1, .waiting = 0});
    const ComputeGate::Place taken = gate.enter();
    for (const char* path : {"/v1/simulate", "/v1/manifold"})
        for (const char* method : {"GET", "POST"}) {
            CAPTURE(path);
            CAPTURE(method);
            CHECK(answer_of(gate, {}, method, path).status == 503);
        }
}

TEST_CASE("a manifold is answered without a recommended b where there is no time to try any") {
    ComputeGate gate({.running = 1});
    const RouteOptions hasty = {.deadline = 0};
    const Json answer = Json::parse(answer_of(gate, hasty, "GET", "/v1/manifold").body);
    CHECK(answer["manifold"]["stable"]["C"].size() == 200);
    CHECK(answer["manifold"]["recommended"].is_null());
    CHECK(warns_of(answer, "no b is recommended: the server's time limit"));
    CHECK_FALSE(warns_of(answer, "none of those tried"));
    const Json whole = Json::parse(answer_of(gate, {}, "GET", "/v1/manifold").body);
    CHECK(whole["manifold"]["recommended"].is_object());
    CHECK_FALSE(warns_of(whole, "time limit"));
}
