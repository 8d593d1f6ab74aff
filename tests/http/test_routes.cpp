// Answers of the routes, without a socket.
#include <doctest/doctest.h>

#include <string>

#include "api/schema/field.hpp"
#include "http/access.hpp"
#include "http/encoding.hpp"
#include "http/routes.hpp"

using namespace vines::http;
using vines::api::Json;

namespace {

Response answer_of(
    AdmissionControl& admission, const RouteOptions& options, const std::string& method,
    const std::string& target, const std::string& body = "{}", bool has_left = false,
    std::vector<Header> headers = {}) {
    static const AdmissionControl idle({});
    static Metrics metrics(idle);  // outlives the streams
    const std::vector<Route> routes = make_routes(options, admission, metrics);
    Request request{
        .head = {.method = method, .target = target, .headers = std::move(headers)},
        .body = body,
        .left = [has_left] { return has_left; }};
    const Route* route = find_route(routes, method, request.head.path());
    REQUIRE(route);
    return route->answer(request);
}

/// A client that leaves after receiving `most` bytes.
class Client : public Writer {
public:
    explicit Client(std::size_t most = 1 << 30) : most_(most) {}
    bool write(std::string_view piece) override {
        text += piece;
        return text.size() < most_;
    }
    bool connected() override { return text.size() < most_; }
    std::string text;

private:
    const std::size_t most_;
};

// In SI units: each column to come has an SI counterpart.
const char* const many_impacts =
    R"({"preset": "fig20", "tau_end": 400, "include": ["impacts", "series", "exponents"]})";

bool warns_of(const Json& answer, const std::string& text) {
    return answer["warnings"].dump().find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("simulations and manifolds are refused while the queue for computing is full") {
    AdmissionControl admission({.running = 1, .waiting = 0});
    const AdmissionControl::Slot taken = admission.acquire("");
    for (const char* path : {"/v1/simulate", "/v1/manifold"})
        for (const char* method : {"GET", "POST"}) {
            CAPTURE(path);
            CAPTURE(method);
            CHECK(answer_of(admission, {}, method, path).status == 503);
        }
}

TEST_CASE("a manifold has no recommended b if the deadline leaves no time to try any") {
    AdmissionControl admission({.running = 1});
    const RouteOptions hasty = {.deadline = 0};
    const Json answer = Json::parse(answer_of(admission, hasty, "GET", "/v1/manifold").body);
    CHECK(answer["manifold"]["stable"]["C"].size() == 200);
    CHECK(answer["manifold"]["recommended"].is_null());
    CHECK(warns_of(answer, "no b is recommended: the server's time limit"));
    CHECK_FALSE(warns_of(answer, "no tried value"));
    const Json whole = Json::parse(answer_of(admission, {}, "GET", "/v1/manifold").body);
    CHECK(whole["manifold"]["recommended"].is_object());
    CHECK_FALSE(warns_of(whole, "time limit"));
}

TEST_CASE("an identification ended by its deadline reports the stage it had reached") {
    AdmissionControl admission({.running = 1});
    std::string record = R"({"preset":"fig15","record":{"time_s":[0)", zeros = "[0";
    for (int k = 1; k < 200; ++k) record += "," + std::to_string(0.001 * k), zeros += ",0";
    record += "],\"a\":" + zeros + "]}}";
    const Response late = answer_of(admission, {.deadline = 0}, "POST", "/v1/identify", record);
    CHECK(late.status == 413);
    const std::string detail = late.problem.value().what();
    CHECK(
        detail.find(
            "the identification was stopped while looking for spikes (a record of 200 samples)") ==
        0);
    CHECK(answer_of(admission, {}, "POST", "/v1/identify", record).status == 422);
}

TEST_CASE("a large answer is compressed by the computing thread, unless its client has left") {
    AdmissionControl admission({.running = 1});
    const auto ask = [&](const std::string& encoding, bool has_left = false) {
        return answer_of(
            admission, {}, "GET", "/v1/simulate?preset=fig3", "", has_left,
            {{"accept-encoding", encoding}});
    };
    const Response plain = ask(""), packed = ask("gzip");
    CHECK(plain.uncompressed_size == 0);
    REQUIRE(packed.uncompressed_size == plain.body.size());
    CHECK(packed.body == gzip(plain.body));
    CHECK(packed.tag == plain.tag);
    CHECK(packed.timing.back().first == "encode");
    CHECK(ask("gzip", true).status == 499);
}

TEST_CASE(
    "reading a body ends at the deadline, when the client leaves, and when the server stops") {
    std::string zeros = "0";
    for (int k = 0; k < 20000; ++k) zeros += ",0";
    for (const char* path : {"/v1/simulate", "/v1/manifold", "/v1/sweep", "/v1/identify"}) {
        CAPTURE(path);
        AdmissionControl admission({.running = 1});
        const std::string body = "{\"q\":[" + zeros + "]}";
        const Response late = answer_of(admission, {.deadline = 0}, "POST", path, body);
        CHECK(late.status == 413);
        CHECK(
            std::string(late.problem.value().what())
                .find("limit of 0 s for one request was over before it was read") !=
            std::string::npos);
        CHECK(answer_of(admission, {}, "POST", path, body).status == 422);
        CHECK(answer_of(admission, {.deadline = 0}, "POST", path, body, true).status == 499);
        admission.stop_all();
        const Response ended = answer_of(admission, {.deadline = 0}, "POST", path, body);
        CHECK(ended.status == 503);
        CHECK(ended.problem.value().lacking == "stopping");
    }
}

TEST_CASE(
    "a body with more parts than any request can have is refused; the starts of a large sweep are "
    "accepted") {
    AdmissionControl admission({.running = 1});
    const RouteOptions few{.sweep_points = 10};
    const auto sweep = [](int starts) {
        std::string text = R"({"axes":[{"parameter":"b","values":[0.02]}],"starts":[{})";
        for (int k = 1; k < starts; ++k) text += ",{}";
        return text + "]}";
    };
    const Response many = answer_of(admission, few, "POST", "/v1/sweep", sweep(100000));
    CHECK(many.status == 413);
    CHECK(
        std::string(many.problem.value().what()) ==
        "the JSON text holds more than 100000 arrays, objects and names");
    CHECK(answer_of(admission, few, "POST", "/v1/sweep", sweep(10)).status == 200);
    CHECK(answer_of(admission, few, "POST", "/v1/sweep", sweep(11)).status == 422);
}

TEST_CASE("a streamed answer has the same bytes as the answer in one piece") {
    AdmissionControl admission({.running = 1});
    for (const char* body :
         {many_impacts, R"({"b": 0.003, "tau_end": 300, "include": ["impacts", "regime"]})",
          R"({"b": 0.015, "tau_end": 300, "max_impacts": 77, "include": ["impacts"]})"}) {
        CAPTURE(body);
        const Response whole = answer_of(admission, {}, "POST", "/v1/simulate", body),
                       streamed = answer_of(
                           admission, {.most_kept_impacts = 20}, "POST", "/v1/simulate", body);
        REQUIRE_FALSE(whole.stream);
        REQUIRE(streamed.stream);
        Client client;
        CHECK(streamed.stream(client));
        CHECK(client.text == whole.body);
    }
}

TEST_CASE("the last impacts of a truncated list can be streamed, too") {
    AdmissionControl admission({.running = 1});
    const RouteOptions whole{.answer_limit = 150000},
        streamed{.answer_limit = 150000, .most_kept_impacts = 20};
    const char* const body = R"({"b": 0.003, "include": ["impacts"]})";
    const Response one = answer_of(admission, whole, "POST", "/v1/simulate", body);
    CHECK(warns_of(Json::parse(one.body), "impacts"));
    Client client;
    CHECK(answer_of(admission, streamed, "POST", "/v1/simulate", body).stream(client));
    CHECK(client.text == one.body);
}

TEST_CASE("a stream ends when its client leaves, and releases its slot") {
    AdmissionControl admission({.running = 1, .waiting = 0});
    const Response response =
        answer_of(admission, {.most_kept_impacts = 20}, "POST", "/v1/simulate", many_impacts);
    Client client(20000);
    CHECK_FALSE(response.stream(client));
    CHECK(client.text.size() < 40000);
    CHECK(admission.acquire(""));
}

TEST_CASE("a started answer is finished while the server prepares to stop") {
    AdmissionControl admission({.running = 1});
    const Response response =
        answer_of(admission, {.most_kept_impacts = 20}, "POST", "/v1/simulate", many_impacts);
    admission.stop_sweeps();
    Client client;
    CHECK(response.stream(client));
    CHECK(Json::accept(client.text));
}
