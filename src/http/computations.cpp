#include "http/computations.hpp"

#include <fmt/format.h>

#include <utility>

#include "api/format/answer_form.hpp"
#include "api/identify.hpp"
#include "api/parse_object.hpp"
#include "api/version.hpp"
#include "http/accept.hpp"
#include "http/answer_stream.hpp"
#include "http/encoding.hpp"
#include "http/end_of_work.hpp"
#include "http/memory.hpp"
#include "http/sweep_stream.hpp"

namespace vines::http {

namespace {

using api::Json;
using api::Problem;

// From this size on an answer's memory is given back to the system at once.
constexpr std::size_t large = 16 << 20;

// Bytes, beside the request that it holds.
constexpr std::size_t most_provenance = 512;

/// What a request asks for, and how it wants to be told.
struct Asked {
    Json fields;
    api::AnswerForm form;
    api::Format format;
    api::Provenance provenance;
    std::size_t provenance_bytes;  ///< at most
};

/// A place to compute in, once it is free, or Problem 503.
ComputeGate::Place place_in(ComputeGate& gate, const Request& request, Stopwatch& watch) {
    ComputeGate::Place place = gate.enter(request.left);
    if (!place && request.left()) throw Problem(499, "the client has left");  // for the log alone
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

Asked asked(
    const Request& r, const api::FieldTable& table, Json fields, api::Provenance provenance) {
    Asked asked{
        .fields = std::move(fields),
        .form = {},
        .format = {},
        .provenance = std::move(provenance),
        .provenance_bytes = 0};
    asked.form = api::take_form(asked.fields, table);
    asked.format = asked.form.format ? *asked.form.format : accepted_format(r.accept);
    asked.provenance_bytes = asked.provenance.request.dump().size() + most_provenance;
    return asked;
}

/// Of a GET or a POST.
Asked asked(const Request& r, const api::FieldTable& table) {
    Json fields = r.method == "POST" ? body_of(r) : api::from_query(table, r.query);
    api::Provenance provenance{.route = r.path, .request = api::canonical(fields)};
    return asked(r, table, std::move(fields), std::move(provenance));
}

/// The same requests to the same build, with the same limit of its answers, have the same answer.
/// Only what is read can be known already: a POST has no tag.
std::string tag_of(const Request& r, const Asked& asked, std::size_t answer_limit) {
    if (r.method == "POST") return {};
    return entity_tag(fmt::format(
        "{} {} {} {}", api::version(), api::name_of(asked.format).word, answer_limit,
        api::describe(asked.provenance, nullptr).dump()));
}

bool is_known(const Request& r, const std::string& tag) {
    return !tag.empty() && names_tag(r.known_tags, tag);
}

/// What is said of formats is said by each of them.
const std::pair<std::string, std::string> varies{"Vary", "Accept"};

Response not_modified(const std::string& tag) {
    return {.status = 304, .tag = tag, .headers = {varies}};
}

/// Problem 413 beyond the limit.
Response encoded_response(Json answer, const Asked& asked, std::size_t limit, Stopwatch& watch) {
    watch.lap("solve");
    api::thin(answer, asked.form.fields);
    std::string bytes = api::encoded(std::move(answer), asked.format, asked.provenance);
    if (bytes.size() >= large) give_memory_back();
    if (bytes.size() > limit + asked.provenance_bytes)
        throw Problem(
            413, fmt::format(
                     "the answer has {} bytes, and this server sends no more than {}: ask for "
                     "fewer parts (include, fields), points (max_points) or impacts (max_impacts)",
                     bytes.size(), limit));
    watch.lap("encode");
    return {
        .content_type = api::name_of(asked.format).media_type,
        .body = std::move(bytes),
        .headers = {varies}};
}

}  // namespace

Response simulate(const Request& r, const Service& service, Stopwatch& watch) {
    const RouteOptions& options = service.options;
    const ComputeGate::Place place = place_in(service.gate, r, watch);
    Asked asked = vines::http::asked(r, api::simulate_fields());
    const std::string tag = tag_of(r, asked, options.answer_limit);
    api::SimulateRequest request = api::read_simulate_request(asked.fields);
    if (is_known(r, tag)) return not_modified(tag);
    watch.lap("parse");
    const api::Stop stop = end_of_work(options.deadline, r, service.gate);
    // Only text is written while its lists are made.
    const std::size_t most_kept =
        asked.format == api::Format::json ? options.most_kept_impacts : everything;
    api::SimulateAnswer answer =
        api::simulate_in_parts(std::move(request), stop, options.answer_limit, most_kept);
    if (answer.is_fitted) asked.provenance.answer_limit = options.answer_limit;
    service.metrics.count_simulation(answer.impacts);
    if (answer.run) {
        watch.lap("solve");
        api::thin(answer.json, asked.form.fields);
        answer.provenance = asked.provenance;
        Response response = stream_answer(std::move(answer), r.id, service.gate);
        response.headers.push_back(varies);
        return response;
    }
    Response response =
        encoded_response(std::move(answer.json), asked, options.answer_limit, watch);
    if (!stop.asked()) response.tag = tag;  // another time it may get further
    return response;
}

Response manifold(const Request& r, const Service& service, Stopwatch& watch) {
    const ComputeGate::Place place = place_in(service.gate, r, watch);
    const Asked asked = vines::http::asked(r, api::manifold_fields());
    const std::string tag = tag_of(r, asked, service.options.answer_limit);
    const api::ManifoldRequest request = api::read_manifold_request(asked.fields);
    if (is_known(r, tag)) return not_modified(tag);
    watch.lap("parse");
    const api::Stop stop = end_of_work(service.options.deadline, r, service.gate);
    Response response = encoded_response(
        api::manifold_answer(request, stop), asked, service.options.answer_limit, watch);
    if (!stop.asked()) response.tag = tag;  // another time it may get further
    return response;
}

Response sweep(const Request& r, const Service& service, Stopwatch& watch) {
    const ComputeGate::Place place = place_in(service.gate, r, watch);  // to read the request
    api::SweepRequest request = api::read_sweep_request(body_of(r), service.options.sweep_points);
    watch.lap("parse");
    return stream_sweep(
        std::move(request), service.options.sweep_deadline, r.id, service.gate, service.metrics);
}

Response identify(const Request& r, const Service& service, Stopwatch& watch) {
    const ComputeGate::Place place = place_in(service.gate, r, watch);
    const api::Stop stop = end_of_work(service.options.deadline, r, service.gate);
    const api::FieldTable& table = api::identify_fields();
    const bool csv =
        r.content_type.starts_with("text/csv") || r.content_type.starts_with("text/plain");
    Json fields = csv ? api::from_query(table, r.query) : body_of(r);
    api::Provenance provenance = api::identify_provenance(fields, r.body);
    const Asked asked = vines::http::asked(r, table, std::move(fields), std::move(provenance));
    const api::IdentifyRequest request = csv ? api::read_identify_request(asked.fields, r.body)
                                             : api::read_identify_request(asked.fields);
    watch.lap("parse");
    return encoded_response(
        api::identify_answer(request, {.stop = stop.asked}), asked, service.options.answer_limit,
        watch);
}

}  // namespace vines::http
