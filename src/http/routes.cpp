#include "http/routes.hpp"

#include <malloc.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "api/identify.hpp"
#include "api/openapi.hpp"
#include "api/presets.hpp"
#include "api/simulate.hpp"
#include "http/assets.hpp"
#include "http/sweep_stream.hpp"

namespace vines::http {

namespace {

using api::Json;
using api::Problem;

Response json_response(const Json& json) { return {200, "application/json", json.dump() + "\n"}; }

// From this size on an answer's memory is given back to the system at once.
constexpr std::size_t large = 1 << 20;

/// The text of an answer, whose parts are freed as they are written.
std::string written(Json answer) {
    std::string text;
    for (auto& [name, part] : answer.get_ref<Json::object_t&>()) {
        text += text.empty() ? '{' : ',';
        text += Json(name).dump();
        text += ':';
        text += part.dump();
        part = nullptr;
    }
    text += "}\n";
    return text;
}

/// As json_response(), for answers that may be large: Problem 413 beyond the limit.
Response limited_response(Json answer, std::size_t limit) {
    std::string text = written(std::move(answer));
#ifdef __GLIBC__
    if (text.size() >= large) malloc_trim(0);  // what a thousand small arrays leave behind
#endif
    if (text.size() > limit)
        throw Problem(
            413,
            "the answer has " + std::to_string(text.size()) +
                " bytes, and this server sends no more than " + std::to_string(limit) +
                ": ask for fewer parts (include), points (max_points) or impacts (max_impacts)");
    return {200, "application/json", std::move(text)};
}

Response problem_response(const Problem& problem) {
    Response r{problem.status, "application/problem+json", problem.body()};
    if (problem.status == 503) r.headers.emplace_back("Retry-After", "1");
    return r;
}

// Everything from this server, nothing inline: the page's scripts and styles are files.
const char* const page_policy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self' data:; connect-src "
    "'self'; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'none'";

Response page_file(std::string_view path, std::string content) {
    Response r{200, std::string(content_type_of(path)), std::move(content)};
    r.headers = {
        {"Content-Security-Policy", page_policy},
        {"X-Content-Type-Options", "nosniff"},
        {"Referrer-Policy", "no-referrer"}};
    return r;
}

/// A place to compute in, or Problem 503.
struct Entered {
    explicit Entered(ComputeGate& gate) : place(gate) {
        if (!place)
            throw Problem(
                503,
                "as many requests as the server takes are waiting already; try again in a second");
    }
    const ComputeGate::Place place;
};

// A run that its deadline ends is analysed and made up into an answer in this share of it more, the
// first half of that for the analysis.
constexpr double time_to_write = 0.2;

Response simulate(const Json& object, const RouteOptions& options, ComputeGate& gate) {
    const api::SimulateRequest request = api::read_simulate_request(object);
    const Entered entered(gate);
    using Clock = std::chrono::steady_clock;
    const auto now = Clock::now();
    const std::chrono::duration<double> time(options.deadline);
    api::Stop stop;
    stop.asked = [deadline = now + time] { return Clock::now() > deadline; };
    stop.analysis_late = [deadline = now + (1 + time_to_write / 2) * time] {
        return Clock::now() > deadline;
    };
    stop.late = [deadline = now + (1 + time_to_write) * time] { return Clock::now() > deadline; };
    return limited_response(
        api::simulate_answer(request, stop, options.answer_limit), options.answer_limit);
}

Response manifold(const Json& object, const RouteOptions& options) {
    return limited_response(
        api::manifold_answer(api::read_manifold_request(object)), options.answer_limit);
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
    const Entered entered(gate);
    return limited_response(api::identify_answer(request), options.answer_limit);
}

/// A route whose answer may throw a Problem.
Route route(std::string method, std::string path, std::function<Response(const Request&)> answer) {
    return {
        std::move(method), std::move(path), [answer = std::move(answer)](const Request& request) {
            try {
                return answer(request);
            } catch (const Problem& problem) {
                return problem_response(problem);
            }
        }};
}

}  // namespace

Response problem_response(int status, const std::string& detail) {
    return problem_response(Problem(status, detail));
}

std::string_view content_type_of(std::string_view path) {
    const std::string_view ending = path.substr(std::min(path.rfind('.'), path.size()));
    if (ending == ".js" || ending == ".mjs") return "text/javascript; charset=utf-8";
    if (ending == ".css") return "text/css; charset=utf-8";
    if (ending == ".svg") return "image/svg+xml";
    return "text/html; charset=utf-8";
}

std::vector<Route> make_routes(const RouteOptions& options, ComputeGate& gate) {
    std::vector<Route> routes;
    routes.push_back(route("GET", "/v1/simulate", [options, &gate](const Request& r) {
        return simulate(api::from_query(api::simulate_fields(), r.query), options, gate);
    }));
    routes.push_back(route("POST", "/v1/simulate", [options, &gate](const Request& r) {
        return simulate(body_of(r), options, gate);
    }));
    routes.push_back(route("GET", "/v1/manifold", [options](const Request& r) {
        return manifold(api::from_query(api::manifold_fields(), r.query), options);
    }));
    routes.push_back(route("POST", "/v1/manifold", [options](const Request& r) {
        return manifold(body_of(r), options);
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
        if (gate.closing()) throw Problem(503, "the server is stopping");
        return json_response({{"status", "ok"}});
    }));
    routes.push_back(route("GET", "/version", [](const Request&) {
        return json_response({{"name", "vines"}, {"version", api::version()}});
    }));
    for (const Asset& asset : assets()) {
        routes.push_back(route(
            "GET", std::string(asset.path), [asset, web_dir = options.web_dir](const Request&) {
                if (web_dir.empty()) return page_file(asset.path, std::string(asset.content));
                const std::string name =
                    asset.path == "/" ? "/index.html" : std::string(asset.path);
                std::ifstream file(web_dir + name, std::ios::binary);
                // uPlot's files lie elsewhere.
                if (!file) return page_file(asset.path, std::string(asset.content));
                return page_file(asset.path, {std::istreambuf_iterator<char>(file), {}});
            }));
    }
    return routes;
}

}  // namespace vines::http
