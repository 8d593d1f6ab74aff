// What the routes answer, without a socket.
#include <doctest/doctest.h>

#include <string>

#include "api/schema/json.hpp"
#include "http/encoding.hpp"
#include "http/routes.hpp"

using namespace vines::http;
using vines::api::Json;

namespace {

Response answer_of(
    ComputeGate& gate, const RouteOptions& options, const std::string& method,
    const std::string& path, const std::string& body = "{}", bool has_left = false) {
    static const ComputeGate idle({});
    static Metrics metrics(idle);  // outlives what is streamed
    const std::vector<Route> routes = make_routes(options, gate, metrics);
    const Route* route = find_route(routes, method, path);
    REQUIRE(route);
    return route->answer(
        {.method = method,
         .path = path,
         .query = {},
         .content_type = {},
         .body = body,
         .left = [has_left] { return has_left; }});
}

/// Takes so many bytes, then it is gone.
class Client : public Writer {
public:
    explicit Client(std::size_t most = 1 << 30) : most_(most) {}
    bool write(std::string_view piece) override {
        text += piece;
        return text.size() < most_;
    }
    bool present() override { return text.size() < most_; }
    std::string text;

private:
    const std::size_t most_;
};

// In SI: with twins of columns that are to come.
const char* const many_impacts =
    R"({"preset": "fig20", "tau_end": 400, "include": ["impacts", "series", "exponents"]})";

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

TEST_CASE("an identification that its deadline ends says what it was at") {
    ComputeGate gate({.running = 1});
    std::string record = R"({"preset":"fig15","record":{"time_s":[0)", zeros = "[0";
    for (int k = 1; k < 200; ++k) record += "," + std::to_string(0.001 * k), zeros += ",0";
    record += "],\"a\":" + zeros + "]}}";
    const Response late = answer_of(gate, {.deadline = 0}, "POST", "/v1/identify", record);
    CHECK(late.status == 413);
    const std::string detail = late.problem.value().what();
    CHECK(
        detail.find(
            "the identification was stopped while looking for spikes (a record of 200 samples)") ==
        0);
    CHECK(answer_of(gate, {}, "POST", "/v1/identify", record).status == 422);
}

TEST_CASE("a large answer is compressed where it is computed, and not for a client that has left") {
    ComputeGate gate({.running = 1});
    static const ComputeGate idle({});
    Metrics metrics(idle);
    const std::vector<Route> routes = make_routes({}, gate, metrics);
    const auto ask = [&](const std::string& encoding, std::function<bool()> left) {
        return find_route(routes, "GET", "/v1/simulate")
            ->answer(
                {.method = "GET",
                 .path = "/v1/simulate",
                 .query = vines::api::parse_query("preset=fig3"),
                 .content_type = {},
                 .body = {},
                 .accept_encoding = encoding,
                 .left = std::move(left)});
    };
    const auto never = [] { return false; };
    const Response plain = ask("", never), packed = ask("gzip", never);
    CHECK(plain.gzipped_from == 0);
    REQUIRE(packed.gzipped_from == plain.body.size());
    CHECK(packed.body == gzip(plain.body));
    CHECK(packed.tag == plain.tag);
    CHECK(packed.timing.back().first == "encode");
    const Response unheard = ask("gzip", [] { return true; });
    CHECK(unheard.status == 499);
}

TEST_CASE("a body is not read to its end beyond a deadline, for a client that left, or in a stop") {
    std::string zeros = "0";
    for (int k = 0; k < 20000; ++k) zeros += ",0";
    for (const char* path : {"/v1/simulate", "/v1/manifold", "/v1/sweep", "/v1/identify"}) {
        CAPTURE(path);
        ComputeGate gate({.running = 1});
        const std::string body = "{\"q\":[" + zeros + "]}";
        const Response late = answer_of(gate, {.deadline = 0}, "POST", path, body);
        CHECK(late.status == 413);
        CHECK(
            std::string(late.problem.value().what())
                .find("no longer than 0 s for one request, and has not read all of its body") !=
            std::string::npos);
        CHECK(answer_of(gate, {}, "POST", path, body).status == 422);
        CHECK(answer_of(gate, {.deadline = 0}, "POST", path, body, true).status == 499);
        gate.end_all();
        const Response ended = answer_of(gate, {.deadline = 0}, "POST", path, body);
        CHECK(ended.status == 503);
        CHECK(ended.problem.value().lacking == "stopping");
    }
}

TEST_CASE(
    "a body of more parts than any request has is refused, one of a large sweep's starts not") {
    ComputeGate gate({.running = 1});
    const RouteOptions few{.sweep_points = 10};
    const auto sweep = [](int starts) {
        std::string text = R"({"axes":[{"parameter":"b","values":[0.02]}],"starts":[{})";
        for (int k = 1; k < starts; ++k) text += ",{}";
        return text + "]}";
    };
    const Response many = answer_of(gate, few, "POST", "/v1/sweep", sweep(100000));
    CHECK(many.status == 413);
    CHECK(
        std::string(many.problem.value().what()) ==
        "the JSON text holds more than 100000 arrays, objects and names");
    CHECK(answer_of(gate, few, "POST", "/v1/sweep", sweep(10)).status == 200);
    CHECK(answer_of(gate, few, "POST", "/v1/sweep", sweep(11)).status == 422);
}

TEST_CASE("an answer that leaves as a stream has the bytes of the same one in one piece") {
    ComputeGate gate({.running = 1});
    for (const char* body :
         {many_impacts, R"({"b": 0.003, "tau_end": 300, "include": ["impacts", "regime"]})",
          R"({"b": 0.015, "tau_end": 300, "max_impacts": 77, "include": ["impacts"]})"}) {
        CAPTURE(body);
        const Response whole = answer_of(gate, {}, "POST", "/v1/simulate", body),
                       streamed =
                           answer_of(gate, {.most_kept_impacts = 20}, "POST", "/v1/simulate", body);
        REQUIRE_FALSE(whole.stream);
        REQUIRE(streamed.stream);
        Client client;
        CHECK(streamed.stream(client));
        CHECK(client.text == whole.body);
    }
}

TEST_CASE("the last impacts of a list that is cut leave as a stream, too") {
    ComputeGate gate({.running = 1});
    const RouteOptions whole{.answer_limit = 150000},
        streamed{.answer_limit = 150000, .most_kept_impacts = 20};
    const char* const body = R"({"b": 0.003, "include": ["impacts"]})";
    const Response one = answer_of(gate, whole, "POST", "/v1/simulate", body);
    CHECK(warns_of(Json::parse(one.body), "impacts"));
    Client client;
    CHECK(answer_of(gate, streamed, "POST", "/v1/simulate", body).stream(client));
    CHECK(client.text == one.body);
}

TEST_CASE("a stream whose client leaves is broken off, and holds no place") {
    ComputeGate gate({.running = 1, .waiting = 0});
    const Response response =
        answer_of(gate, {.most_kept_impacts = 20}, "POST", "/v1/simulate", many_impacts);
    Client client(20000);
    CHECK_FALSE(response.stream(client));
    CHECK(client.text.size() < 40000);
    CHECK(gate.enter());
}

TEST_CASE("an answer that has begun is finished while the server is about to stop") {
    ComputeGate gate({.running = 1});
    const Response response =
        answer_of(gate, {.most_kept_impacts = 20}, "POST", "/v1/simulate", many_impacts);
    gate.close_to_sweeps();
    Client client;
    CHECK(response.stream(client));
    CHECK(Json::accept(client.text));
}
