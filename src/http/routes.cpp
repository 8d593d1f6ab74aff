#include "http/routes.hpp"

#include "api/openapi/openapi.hpp"
#include "api/presets.hpp"
#include "api/version.hpp"
#include "http/encoding.hpp"

namespace vines::http {

namespace {

using api::Json;
using api::Problem;

Response json_response(Json json) { return {.body = api::json_text(std::move(json)) + "\n"}; }

/// Calls answer(); a Problem that it throws becomes the response.
Response answer_of(const std::function<Response()>& answer) {
    try {
        return answer();
    } catch (const Problem& problem) {
        return problem_response(problem);
    }
}

Route route(std::string method, std::string path, std::function<Response(Request&)> answer) {
    return {
        .method = std::move(method),
        .path = std::move(path),
        .answer = [answer = std::move(answer)](Request& request) {
            return answer_of([&] { return answer(request); });
        }};
}

/// A constant JSON document, made at the first request (OpenAPI: 0.1 s).
Route document(std::string path, Json (*make)()) {
    struct Made {
        std::once_flag once;
        Response response;
        std::string gzipped;
    };
    return route("GET", std::move(path), [make, made = std::make_shared<Made>()](Request&) {
        std::call_once(made->once, [&] {
            made->response = json_response(make());
            made->response.tag = entity_tag(made->response.body);
            made->gzipped = *gzip(made->response.body);
            made->response.gzipped = made->gzipped;
        });
        return made->response;
    });
}

/// A health route: answered however busy the server is, without a key.
Route health(std::string path, std::function<Response(Request&)> answer) {
    Route made = route("GET", std::move(path), std::move(answer));
    made.on_event_loop = made.is_public = true;
    return made;
}

}  // namespace

// Body of a sweep, bytes: 40,000 starts with all digits.
constexpr std::size_t largest_sweep = 5 << 20;

std::vector<Route> make_routes(
    const RouteOptions& options, AdmissionControl& admission, Metrics& metrics) {
    std::vector<Route> routes;
    const auto service = std::make_shared<const Service>(
        Service{options, admission, metrics, std::make_shared<RunningStreams>()});
    const auto compute = [&](const char* method, const char* path, Computation* computation) {
        routes.push_back(
            {.method = method, .path = path, .answer = [computation, service](Request& r) {
                 Stopwatch watch;
                 Response response = answer_of([&] { return computation(r, *service, watch); });
                 response.timing = watch.take();
                 return response;
             }});
    };
    for (const char* method : {"GET", "POST"}) {
        compute(method, "/v1/simulate", answer);
        compute(method, "/v1/manifold", answer);
    }
    compute("POST", "/v1/sweep", sweep);
    routes.back().body_limit = largest_sweep;
    compute("POST", "/v1/basins", sweep);
    compute("POST", "/v1/continue", continuation);
    compute("POST", "/v1/design", design);
    compute("POST", "/v1/identify", answer);
    routes.back().body_limit = options.record_limit;
    routes.push_back(document("/v1/presets", api::describe_presets));
    routes.push_back(document("/v1/parameters", api::describe_fields));
    routes.push_back(document("/v1/openapi.json", api::openapi));
    // Alive: the process answers. Ready: it accepts work; before a shutdown it is not, so that a
    // proxy sends no more requests.
    for (const char* path : {"/healthz", "/livez"})
        routes.push_back(health(path, [](Request&) { return json_response({{"status", "ok"}}); }));
    routes.push_back(health("/readyz", [&admission](Request&) {
        if (admission.sweeps_stopped()) return stopping_refusal();
        return json_response({{"status", "ok"}});
    }));
    routes.push_back(health("/version", [](Request&) {
        return json_response(
            {{"name", "vines"},
             {"version", api::version()},
             {"commit", api::commit()},
             {"compiler", api::compiler()}});
    }));
    routes.push_back(route("GET", "/metrics", [&metrics](Request&) {
        return Response{.content_type = Metrics::content_type, .body = metrics.text()};
    }));
    routes.back().on_event_loop = true;
    for (Route& r : routes) r.name = r.path;
    for (Route& file : page_routes(options.page)) {
        file.name = "page";
        file.is_public = true;
        file.sets_frame_policy = true;
        routes.push_back(std::move(file));
    }
    return routes;
}

}  // namespace vines::http
