#include "http/routes.hpp"

#include <fmt/format.h>

#include <chrono>

#include "api/identify.hpp"
#include "api/json_text.hpp"
#include "api/openapi.hpp"
#include "api/presets.hpp"
#include "api/schema/parameters.hpp"
#include "api/simulate.hpp"
#include "http/answer_stream.hpp"
#include "http/memory.hpp"
#include "http/page.hpp"
#include "http/problem_response.hpp"
#include "http/sweep_stream.hpp"

namespace vines::http {

namespace {

using api::Json;
using api::Problem;

Response json_response(Json json) { return {.body = api::json_text(std::move(json)) + "\n"}; }

// From this size on an answer's memory is given back to the system at once.
constexpr std::size_t large = 16 << 20;

/// As json_response(), for answers that may be large: Problem 413 beyond the limit.
Response limited_response(Json answer, std::size_t limit) {
    std::string text = api::json_text(std::move(answer)) + "\n";
    if (text.size() >= large) give_memory_back();
    if (text.size() > limit)
        throw Problem(
            413, fmt::format(
                     "the answer has {} bytes, and this server sends no more than {}: ask for "
                     "fewer parts (include), points (max_points) or impacts (max_impacts)",
                     text.size(), limit));
    return {.body = std::move(text)};
}

/// A place to compute in, or Problem 503.
ComputeGate::Place place_in(ComputeGate& gate) {
    if (ComputeGate::Place place = gate.enter()) return place;
    throw Problem(
        503, "as many requests as the server takes are waiting already; try again in a second");
}

// A run that its deadline ends is analysed and made up into an answer in this share of it more, the
// first half of that for the analysis.
constexpr double time_to_write = 0.2;

/// Ends what takes longer than so many seconds from now on.
api::Stop stop_after(double seconds) {
    using Clock = std::chrono::steady_clock;
    const auto now = Clock::now();
    const std::chrono::duration<double> time(seconds);
    api::Stop stop;
    stop.asked = [deadline = now + time] { return Clock::now() > deadline; };
    stop.analysis_late = [deadline = now + (1 + time_to_write / 2) * time] {
        return Clock::now() > deadline;
    };
    stop.late = [deadline = now + (1 + time_to_write) * time] { return Clock::now() > deadline; };
    return stop;
}

Response simulate(const Json& object, const RouteOptions& options, ComputeGate& gate) {
    api::SimulateRequest request = api::read_simulate_request(object);
    const ComputeGate::Place place = place_in(gate);
    api::SimulateAnswer answer = api::simulate_in_parts(
        std::move(request), stop_after(options.deadline), options.answer_limit,
        options.most_kept_impacts);
    if (answer.run) return stream_answer(std::move(answer), gate);
    return limited_response(std::move(answer.json), options.answer_limit);
}

Response manifold(const Json& object, const RouteOptions& options, ComputeGate& gate) {
    const api::ManifoldRequest request = api::read_manifold_request(object);
    const ComputeGate::Place place = place_in(gate);
    return limited_response(
        api::manifold_answer(request, stop_after(options.deadline)), options.answer_limit);
}

Json body_of(const Request& r) {
    if (!r.query.empty())
        throw Problem(400, "a POST takes its fields from the body; the query must be empty");
    return api::parse_object(r.body);
}

/// A CSV file with the fields in the query, or JSON with all in the body.
Response identify(const Request& r, const RouteOptions& options, ComputeGate& gate) {
    const bool csv =
        r.content_type.rfind("text/csv", 0) == 0 || r.content_type.rfind("text/plain", 0) == 0;
    const api::IdentifyRequest request =
        csv ? api::read_identify_request(api::from_query(api::identify_fields(), r.query), r.body)
            : api::read_identify_request(body_of(r));
    const ComputeGate::Place place = place_in(gate);
    return limited_response(
        api::identify_answer(request, {.stop = stop_after(options.deadline).asked}),
        options.answer_limit);
}

/// A route whose answer may throw a Problem.
Route route(std::string method, std::string path, std::function<Response(const Request&)> answer) {
    return {
        .method = std::move(method),
        .path = std::move(path),
        .answer = [answer = std::move(answer)](const Request& request) {
            try {
                return answer(request);
            } catch (const Problem& problem) {
                return problem_response(problem);
            }
        }};
}

}  // namespace

std::vector<Route> make_routes(const RouteOptions& options, ComputeGate& gate) {
    std::vector<Route> routes;
    routes.push_back(route("GET", "/v1/simulate", [options, &gate](const Request& r) {
        return simulate(api::from_query(api::simulate_fields(), r.query), options, gate);
    }));
    routes.push_back(route("POST", "/v1/simulate", [options, &gate](const Request& r) {
        return simulate(body_of(r), options, gate);
    }));
    routes.push_back(route("GET", "/v1/manifold", [options, &gate](const Request& r) {
        return manifold(api::from_query(api::manifold_fields(), r.query), options, gate);
    }));
    routes.push_back(route("POST", "/v1/manifold", [options, &gate](const Request& r) {
        return manifold(body_of(r), options, gate);
    }));
    routes.push_back(route("POST", "/v1/sweep", [options, &gate](const Request& r) {
        return stream_sweep(api::read_sweep_request(body_of(r), options.sweep_points), gate);
    }));
    routes.push_back(route("POST", "/v1/identify", [options, &gate](const Request& r) {
        return identify(r, options, gate);
    }));
    routes.back().body_limit = options.record_limit;
    routes.push_back(route("GET", "/v1/presets", [](const Request&) {
        return json_response(api::describe_presets());
    }));
    routes.push_back(route("GET", "/v1/parameters", [](const Request&) {
        return json_response(api::describe_fields());
    }));
    routes.push_back(route(
        "GET", "/v1/openapi.json", [](const Request&) { return json_response(api::openapi()); }));
    // Alive: the process answers. Ready: it takes work; a proxy stops sending it some once it is
    // about to stop.
    for (const char* path : {"/healthz", "/livez"})
        routes.push_back(
            route("GET", path, [](const Request&) { return json_response({{"status", "ok"}}); }));
    routes.push_back(route("GET", "/readyz", [&gate](const Request&) {
        if (gate.closed_to_sweeps()) throw Problem(503, "the server is stopping");
        return json_response({{"status", "ok"}});
    }));
    routes.push_back(route("GET", "/version", [](const Request&) {
        return json_response({{"name", "vines"}, {"version", api::version()}});
    }));
    for (Route& file : page_routes(options.page)) routes.push_back(std::move(file));
    return routes;
}

}  // namespace vines::http
