#include "http/computations.hpp"

#include <fmt/format.h>

#include <functional>
#include <utility>

#include "api/answers/asked.hpp"
#include "api/broken_off.hpp"
#include "api/parse_object.hpp"
#include "api/schema/tables.hpp"
#include "api/version.hpp"
#include "http/accept.hpp"
#include "http/answer_stream.hpp"
#include "http/compress.hpp"
#include "http/encoding.hpp"
#include "http/end_of_work.hpp"
#include "http/header_text.hpp"
#include "http/memory.hpp"
#include "http/sweep_stream.hpp"
#include "http/turn.hpp"

namespace vines::http {

namespace {

using api::Json;
using api::Problem;

// From this size on an answer's memory is given back to the system at once.
constexpr std::size_t large = 16 << 20;

// Bytes of a body that are read in a small part of a turn's moment.
constexpr std::size_t quickly_read = 16 << 10;

// Bytes of a provenance, beside what was asked for: a hash, the answer's limit.
constexpr std::size_t most_hash = 256;

[[noreturn]] void end_unheard() { throw Problem(499, "the client has left"); }  // for the log alone

/// The request's turn, or Problem 503.
Turn turn_of(const Request& request, ComputeGate& gate, Stopwatch& watch) {
    Turn turn(gate, request.left, request.body.size() <= quickly_read);
    if (!turn && request.left()) end_unheard();
    if (!turn)
        throw Problem::unavailable(
            "computing",
            "as many requests as the server takes are waiting already; try again in a second");
    watch.lap("queue");
    return turn;
}

Json body_of(const Request& r) {
    if (!r.query.empty())
        throw Problem(400, "a POST takes its fields from the body; the query must be empty");
    return api::parse_object(r.body);
}

api::Asked asked_run(const Request& r, const api::FieldTable& table) {
    return api::read_asked(
        r.path, r.method == "POST" ? body_of(r) : api::from_query(table, r.query));
}

api::Asked asked_identification(const Request& r) {
    const std::string type = media_type(r.content_type);
    const bool is_columns = type == "text/csv" || type == "text/plain";
    return api::read_asked(
        r.path, is_columns ? api::from_query(api::identify_fields(), r.query) : body_of(r),
        {r.body, is_columns});
}

/// What is said of formats is said by each of them.
const std::pair<std::string, std::string> varies{"Vary", "Accept"};

/// The same requests to the same build, with the same limit of its answers, have the same answer.
/// Only what is read can be known already: a POST has no tag.
std::string tag_of(
    const Request& r, api::Format format, std::size_t answer_limit, const std::string& provenance) {
    if (r.method == "POST") return {};
    return entity_tag(fmt::format(
        "{} {} {} {}", api::version(), api::name_of(format).word, answer_limit, provenance));
}

/// Problem 413 beyond the limit, to which what it tells of its provenance does not count.
std::string encoded(
    api::Answer answer, api::Format format, std::size_t limit, std::size_t provenance,
    const std::function<bool()>& gives_up) {
    try {
        std::string bytes =
            api::encoded(std::move(answer.json), format, answer.provenance, gives_up);
        if (bytes.size() >= large) give_memory_back();
        if (bytes.size() <= limit + provenance) return bytes;
        throw Problem(
            413, fmt::format(
                     "the answer has {} bytes, and this server sends no more than {}: ask for "
                     "fewer parts (include, fields), points (max_points) or impacts (max_impacts)",
                     bytes.size(), limit));
    } catch (const api::BrokenOff&) {
        end_unheard();
    }
}

/// The answer to what is read(request), in a place to compute in.
Response answer(
    const Request& r, const Service& service, Stopwatch& watch,
    const std::function<api::Asked(const Request&)>& read) {
    Turn turn = turn_of(r, service.gate, watch);
    const RouteOptions& options = service.options;
    const api::Stop stop = end_of_work(options.deadline, r, service.gate, turn);
    api::Asked asked = read(r);
    std::optional<api::Format>& format = asked.form.format;
    if (!format) format = accepted_format(r.accept);
    const std::string provenance = api::describe(asked.provenance, nullptr).dump();
    std::string tag = tag_of(r, *format, options.answer_limit, provenance);
    if (!tag.empty() && names_tag(r.known_tags, tag))
        return {.status = 304, .tag = tag, .headers = {varies}};
    watch.lap("parse");
    api::Answer answer = api::answered(
        std::move(asked),
        {.stop = stop, .most_bytes = options.answer_limit, .most_kept = options.most_kept_impacts});
    const bool goes_on = turn.goes_on();
    watch.lap("solve");
    watch.move("solve", "queue", turn.waited());
    if (!goes_on) end_unheard();
    service.metrics.count_impacts(answer.impacts);
    if (answer.run) {
        Response response = stream_answer(std::move(answer), r.id, service.gate);
        response.headers.push_back(varies);
        return response;
    }
    std::string bytes = encoded(
        std::move(answer), *format, options.answer_limit, provenance.size() + most_hash, r.left);
    if (stop.asked()) tag = {};  // another time it may get further
    Response response{
        .content_type = api::name_of(*format).media_type,
        .body = std::move(bytes),
        .tag = std::move(tag),
        .headers = {varies}};
    const auto waited = turn.waited();
    if (!compress(response, r, [&] { return !turn.goes_on() || r.left(); })) end_unheard();
    watch.lap("encode");
    watch.move("encode", "queue", turn.waited() - waited);
    return response;
}

}  // namespace

Response simulate(const Request& r, const Service& service, Stopwatch& watch) {
    return answer(r, service, watch, [](const Request& request) {
        return asked_run(request, api::simulate_fields());
    });
}

Response manifold(const Request& r, const Service& service, Stopwatch& watch) {
    return answer(r, service, watch, [](const Request& request) {
        return asked_run(request, api::manifold_fields());
    });
}

Response identify(const Request& r, const Service& service, Stopwatch& watch) {
    return answer(r, service, watch, asked_identification);
}

Response sweep(const Request& r, const Service& service, Stopwatch& watch) {
    const Turn turn = turn_of(r, service.gate, watch);  // to read the request
    api::SweepRequest request = api::read_sweep_request(body_of(r), service.options.sweep_points);
    watch.lap("parse");
    return stream_sweep(
        std::move(request), service.options.sweep_deadline, r.id, service.gate, service.metrics);
}

}  // namespace vines::http
