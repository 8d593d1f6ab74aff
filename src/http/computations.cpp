#include "http/computations.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <utility>

#include "api/answers/asked.hpp"
#include "api/broken_off.hpp"
#include "api/parse_object.hpp"
#include "api/reading.hpp"
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

// Of the largest body by default, one in four characters: a record that is a measurement has eight
// characters a number or more. They take 300 MB at most while they are read.
constexpr std::size_t most_numbers = 16'000'000;

// In the fields beside the record: impact_times_s may tell each impact in it.
constexpr std::size_t most_beside = 1'000'000;

// Arrays, objects and names: a start of a sweep is one with up to six names, and there are no more
// starts than points. All other fields together have some thousand.
constexpr std::size_t parts_of_a_point = 10, least_parts = 100'000;

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

/// What a body may hold for a request that gives up with `stop`.
api::Reading reading_of(const RouteOptions& options, const api::Stop& stop) {
    return {
        .gives_up = stop.asked,
        .most_numbers = most_numbers,
        .most_beside = most_beside,
        .most_parts = std::max(least_parts, parts_of_a_point * options.sweep_points)};
}

/// What read() returns. A Problem where that took too long, or is not needed any more: nothing is
/// computed yet that could be told instead.
template <class Read>
auto read_in_time(const Request& r, const Service& service, const Read& read) {
    try {
        return read();
    } catch (const api::BrokenOff&) {
        if (r.left()) end_unheard();
        if (service.gate.ends_all())
            throw Problem::unavailable("stopping", "the server is stopping");
        throw Problem(
            413, fmt::format(
                     "this server computes no longer than {} s for one request, and has not read "
                     "all of its body in them: a smaller one takes less time",
                     service.options.deadline));
    }
}

Json body_of(const Request& r, const api::Reading& reading) {
    if (!r.query.empty())
        throw Problem(400, "a POST takes its fields from the body; the query must be empty");
    return api::parse_object(r.body, reading);
}

api::Asked asked_run(const Request& r, const api::FieldTable& table, const api::Reading& reading) {
    return api::read_asked(
        r.path, r.method == "POST" ? body_of(r, reading) : api::from_query(table, r.query));
}

api::Asked asked_identification(const Request& r, const api::Reading& reading) {
    const std::string type = media_type(r.content_type);
    const bool is_columns = type == "text/csv" || type == "text/plain";
    return api::read_asked(
        r.path, is_columns ? api::from_query(api::identify_fields(), r.query) : body_of(r, reading),
        {r.body, is_columns}, reading);
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

/// Ends parts of the work, each without what it waited for its place.
class Laps {
public:
    Laps(Stopwatch& watch, const Turn& turn) : watch_(watch), turn_(turn) {}
    void lap(const char* part) {
        watch_.lap(part);
        const auto waited = turn_.waited();
        watch_.move(part, "queue", waited - waited_);
        waited_ = waited;
    }

private:
    Stopwatch& watch_;
    const Turn& turn_;
    decltype(std::declval<const Turn>().waited()) waited_{};
};

/// The answer to what is read(request), in a place to compute in.
Response answer(
    const Request& r, const Service& service, Stopwatch& watch,
    const std::function<api::Asked(const Request&, const api::Reading&)>& read) {
    Turn turn = turn_of(r, service.gate, watch);
    const RouteOptions& options = service.options;
    const api::Stop stop = end_of_work(options.deadline, r, service.gate, turn);
    Laps laps(watch, turn);
    api::Asked asked = read_in_time(r, service, [&] { return read(r, reading_of(options, stop)); });
    std::optional<api::Format>& format = asked.form.format;
    if (!format) format = accepted_format(r.accept);
    const std::string provenance = api::describe(asked.provenance, nullptr).dump();
    std::string tag = tag_of(r, *format, options.answer_limit, provenance);
    if (!tag.empty() && names_tag(r.known_tags, tag))
        return {.status = 304, .tag = tag, .headers = {varies}};
    laps.lap("parse");
    api::Answer answer = api::answered(
        std::move(asked),
        {.stop = stop, .most_bytes = options.answer_limit, .most_kept = options.most_kept_impacts});
    const bool goes_on = turn.goes_on();
    laps.lap("solve");
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
    if (!compress(response, r, [&] { return !turn.goes_on() || r.left(); })) end_unheard();
    laps.lap("encode");
    return response;
}

}  // namespace

Response simulate(const Request& r, const Service& service, Stopwatch& watch) {
    return answer(r, service, watch, [](const Request& request, const api::Reading& reading) {
        return asked_run(request, api::simulate_fields(), reading);
    });
}

Response manifold(const Request& r, const Service& service, Stopwatch& watch) {
    return answer(r, service, watch, [](const Request& request, const api::Reading& reading) {
        return asked_run(request, api::manifold_fields(), reading);
    });
}

Response identify(const Request& r, const Service& service, Stopwatch& watch) {
    return answer(r, service, watch, asked_identification);
}

Response sweep(const Request& r, const Service& service, Stopwatch& watch) {
    Turn turn = turn_of(r, service.gate, watch);  // to read the request
    const RouteOptions& options = service.options;
    const api::Stop stop = end_of_work(options.deadline, r, service.gate, turn);
    api::SweepRequest request = read_in_time(r, service, [&] {
        return api::read_sweep_request(body_of(r, reading_of(options, stop)), options.sweep_points);
    });
    Laps(watch, turn).lap("parse");
    return stream_sweep(
        std::move(request), service.options.sweep_deadline, r.id, service.gate, service.metrics);
}

}  // namespace vines::http
