#include "http/routes.hpp"

#include <fmt/format.h>

#include <chrono>
#include <functional>
#include <memory>

#include "api/identify.hpp"
#include "api/json_text.hpp"
#include "api/openapi/openapi.hpp"
#include "api/parse_object.hpp"
#include "api/presets.hpp"
#include "api/schema/parameters.hpp"
#include "api/simulate.hpp"
#include "http/answer_stream.hpp"
#include "http/encoding.hpp"
#include "http/end_of_work.hpp"
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

/// The same with the time of each part of the work, whose last one, the solution, is just over.
Response timed_response(Json answer, std::size_t limit, Stopwatch& watch) {
    watch.lap("solve");
    Response response = limited_response(std::move(answer), limit);
    watch.lap("encode");
    response.timing = watch.take();
    return response;
}

/// What a computation is made with.
struct Service {
    const RouteOptions options;
    ComputeGate& gate;
    Metrics& metrics;
};

/// A place to compute in, once it is free, or Problem 503.
ComputeGate::Place place_in(ComputeGate& gate, const Request& request, Stopwatch& watch) {
    ComputeGate::Place place = gate.enter(request.left);
    if (!place)
        throw Problem::unavailable(
            "computing",
            "as many requests as the server takes are waiting already; try again in a second");
    watch.lap("queue");
    return place;
}

Json body_of(const Request& r) {
    if (!r.query.empty())
        throw Problem(400, "a POST takes its fields from the body; the query must be empty");
    return api::parse_object(r.body);
}

/// The fields of a GET or a POST.
Json fields_of(const Request& r, const api::FieldTable& table) {
    return r.method == "POST" ? body_of(r) : api::from_query(table, r.query);
}

/// The same requests to the same version, with the same limit of its answers, have the same answer.
/// Only what is read can be known already: a POST has no tag.
std::string tag_of(const Request& r, const Json& fields, std::size_t answer_limit) {
    if (r.method == "POST") return {};
    return entity_tag(
        fmt::format("{} {} {} {}", r.path, api::version(), answer_limit, fields.dump()));
}

Response simulate(const Request& r, const Service& service) {
    Stopwatch watch;
    const ComputeGate::Place place = place_in(service.gate, r, watch);
    const Json fields = fields_of(r, api::simulate_fields());
    const std::string tag = tag_of(r, fields, service.options.answer_limit);
    api::SimulateRequest request = api::read_simulate_request(fields);
    if (!tag.empty() && names_tag(r.known_tags, tag)) return {.status = 304, .tag = tag};
    watch.lap("parse");
    const api::Stop stop = end_of_work(service.options.deadline, r, service.gate);
    api::SimulateAnswer answer = api::simulate_in_parts(
        std::move(request), stop, service.options.answer_limit, service.options.most_kept_impacts);
    service.metrics.count_simulation(answer.impacts);
    if (answer.run) {
        watch.lap("solve");
        Response response = stream_answer(std::move(answer), r.id, service.gate);
        response.timing = watch.take();
        return response;
    }
    Response response = timed_response(std::move(answer.json), service.options.answer_limit, watch);
    if (!stop.asked()) response.tag = tag;  // another time it may get further
    return response;
}

Response manifold(const Request& r, const Service& service) {
    Stopwatch watch;
    const ComputeGate::Place place = place_in(service.gate, r, watch);
    const api::ManifoldRequest request =
        api::read_manifold_request(fields_of(r, api::manifold_fields()));
    watch.lap("parse");
    return timed_response(
        api::manifold_answer(request, end_of_work(service.options.deadline, r, service.gate)),
        service.options.answer_limit, watch);
}

Response sweep(const Request& r, const Service& service) {
    Stopwatch watch;
    const ComputeGate::Place place = place_in(service.gate, r, watch);  // to read the request
    api::SweepRequest request = api::read_sweep_request(body_of(r), service.options.sweep_points);
    watch.lap("parse");
    Response response = stream_sweep(
        std::move(request), service.options.sweep_deadline, r.id, service.gate, service.metrics);
    response.timing = watch.take();
    return response;
}

/// A CSV file with the fields in the query, or JSON with all in the body.
Response identify(const Request& r, const Service& service) {
    Stopwatch watch;
    const ComputeGate::Place place = place_in(service.gate, r, watch);
    const api::Stop stop = end_of_work(service.options.deadline, r, service.gate);
    const bool csv =
        r.content_type.rfind("text/csv", 0) == 0 || r.content_type.rfind("text/plain", 0) == 0;
    const api::IdentifyRequest request =
        csv ? api::read_identify_request(api::from_query(api::identify_fields(), r.query), r.body)
            : api::read_identify_request(body_of(r));
    watch.lap("parse");
    return timed_response(
        api::identify_answer(request, {.stop = stop.asked}), service.options.answer_limit, watch);
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

/// One that is answered however busy the server is.
Route light(std::string method, std::string path, std::function<Response(const Request&)> answer) {
    Route made = route(std::move(method), std::move(path), std::move(answer));
    made.light = true;
    return made;
}

}  // namespace

std::vector<Route> make_routes(const RouteOptions& options, ComputeGate& gate, Metrics& metrics) {
    std::vector<Route> routes;
    using Computation = Response (*)(const Request&, const Service&);
    const auto service = std::make_shared<const Service>(Service{options, gate, metrics});
    const auto compute = [&](const char* method, const char* path, Computation answer) {
        routes.push_back(route(
            method, path, [answer, service](const Request& r) { return answer(r, *service); }));
    };
    for (const char* method : {"GET", "POST"}) {
        compute(method, "/v1/simulate", simulate);
        compute(method, "/v1/manifold", manifold);
    }
    compute("POST", "/v1/sweep", sweep);
    compute("POST", "/v1/identify", identify);
    routes.back().body_limit = options.record_limit;
    routes.push_back(route("GET", "/v1/presets", [](const Request&) {
        return json_response(api::describe_presets());
    }));
    routes.push_back(route("GET", "/v1/parameters", [](const Request&) {
        return json_response(api::describe_fields());
    }));
    routes.push_back(route("GET", "/v1/openapi.json", [](const Request&) {
        static const Response made = json_response(api::openapi());  // 20 ms
        return made;
    }));
    // Alive: the process answers. Ready: it takes work; a proxy stops sending it some once it is
    // about to stop.
    for (const char* path : {"/healthz", "/livez"})
        routes.push_back(
            light("GET", path, [](const Request&) { return json_response({{"status", "ok"}}); }));
    routes.push_back(light("GET", "/readyz", [&gate](const Request&) {
        if (gate.closed_to_sweeps())
            throw Problem::unavailable("stopping", "the server is stopping");
        return json_response({{"status", "ok"}});
    }));
    routes.push_back(light("GET", "/version", [](const Request&) {
        return json_response(
            {{"name", "vines"},
             {"version", api::version()},
             {"commit", api::commit()},
             {"compiler", api::compiler()}});
    }));
    routes.push_back(light("GET", "/metrics", [&metrics](const Request&) {
        return Response{.content_type = Metrics::content_type, .body = metrics.text()};
    }));
    for (Route& r : routes) r.name = r.path;
    for (Route& file : page_routes(options.page)) {
        file.name = "page";
        routes.push_back(std::move(file));
    }
    return routes;
}

}  // namespace vines::http
