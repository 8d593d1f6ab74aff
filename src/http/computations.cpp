#include "http/routes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include "api/cancellation.hpp"
#include "api/format/answer_request.hpp"
#include "api/format/sweep_table.hpp"
#include "api/parse.hpp"
#include "api/schema/tables.hpp"
#include "api/version.hpp"
#include "http/admission_control.hpp"
#include "http/encoding.hpp"
#include "http/head.hpp"
#include "http/log.hpp"
#include "http/memory.hpp"
#include "http/streams.hpp"

namespace vines::http {

namespace {

// Extra time, as a fraction of the deadline, for analysing a run that was cut off (first half) and
// for writing its answer.
constexpr double time_to_write = 0.2;

/// True once the client has left or the server stops.
class Abandoned {
public:
    Abandoned(const Request& request, const AdmissionControl& admission)
        : left_(request.left),
          admission_(admission) {}
    /// Checks the connection at most every client_check_interval.
    bool operator()(std::chrono::steady_clock::time_point now) {
        if (now - checked_ > client_check_interval) {
            checked_ = now;
            is_ = is_ || left_() || admission_.all_stopped();
        }
        return is_;
    }

private:
    const std::function<bool()> left_;
    const AdmissionControl& admission_;
    std::chrono::steady_clock::time_point checked_ = std::chrono::steady_clock::now();
    bool is_ = false;
};

/// The conditions that end a computation: more than `seconds` from now, not counting the time in
/// which its permit waits; its client has left; or the server stops. `admission` and `permit` must
/// outlive the result, which one thread at a time may call.
api::Stop stop_conditions(
    double seconds, const Request& request, const AdmissionControl& admission, Permit& permit) {
    using Clock = std::chrono::steady_clock;
    const auto now = Clock::now();
    const auto abandoned = std::make_shared<Abandoned>(request, admission);
    const auto after = [now, abandoned, seconds, &permit](double fraction) {
        const std::chrono::duration<double> time(fraction * seconds);
        return [deadline = now + time, abandoned, &permit] {
            if (!permit.renew()) return true;
            const auto at = Clock::now();
            return at - permit.waited() > deadline || (*abandoned)(at);
        };
    };
    return {
        .requested = after(1),
        .analysis_late = after(1 + time_to_write / 2),
        .late = after(1 + time_to_write)};
}

using api::Json;
using api::Problem;

// Answers from this size on return their memory to the system at once, bytes.
constexpr std::size_t large = 16 << 20;

// Largest body that is read in a small part of the grace period, bytes.
constexpr std::size_t max_body_in_grace = 16 << 10;

// Starts of a sweep take 90 times their size while they are read: bodies of all routes but
// /v1/identify count this many times.
constexpr std::size_t weight_of_fields = 16;

// One number per eight characters of the largest default body: a measured record has no fewer. They
// take 64 MB while they are read. To identify a record takes up to 120 bytes for each sample.
constexpr std::size_t most_numbers = 8'000'000;

// Numbers outside the record: impact_times_s can list every impact in it.
constexpr std::size_t most_outside_record = 1'000'000;

// The answer lists the impacts in more than 250 bytes each: the default --answer-limit permits half
// a million.
constexpr std::size_t most_impacts = 500'000;

// Impacts fitted to a record: 25 minutes at 13 per second. A fit takes 2 kB for each.
constexpr std::size_t most_fitted = 20'000;

// Arrays, objects and names: a start of a sweep is an object with up to six names, and there are at
// most as many starts as points. All other fields together have a few thousand.
constexpr std::size_t parts_of_a_point = 10, least_parts = 100'000;

// Largest part of the provenance that is not the request's: a hash and the answer's limit, bytes.
constexpr std::size_t max_hash = 256;

/// Ends the request of a client that has left; only the log shows its status.
[[noreturn]] void throw_client_left() { throw Problem(499, "the client has left"); }

/// Waits for the permit of a large body, for at most `seconds`; Problem 503 if there is none. It
/// comes before the permit to compute, so that waiting requests hold no slot.
AdmissionControl::BodyPermit body_permit_for(
    const Request& r, AdmissionControl& admission, double seconds) {
    const std::size_t bytes = r.body.size() * (r.path == "/v1/identify" ? 1 : weight_of_fields);
    const auto deadline = Stopwatch::Clock::now() + std::chrono::duration<double>(seconds);
    auto permit = admission.acquire_body(r.client, bytes, [&] {
        return r.left() || admission.all_stopped() || Stopwatch::Clock::now() > deadline;
    });
    if (permit) return permit;
    if (r.left()) throw_client_left();
    if (admission.all_stopped()) throw *stopping_refusal().problem;
    throw Problem::unavailable(
        "memory", "other large bodies are being read; try again in a second");
}

/// Ends a request that has no permit: its client has left, or work whose turn is earlier came.
[[noreturn]] void throw_without_permit(const Request& request) {
    if (request.left()) throw_client_left();
    throw Problem::unavailable(
        "computing", "the queue for computing is full; try again in a second");
}

/// Waits for the request's permit to compute; Problem 503 if the queue is full.
Permit permit_for(const Request& request, AdmissionControl& admission, Stopwatch& watch) {
    Permit permit(
        admission, request.client, request.left, request.body.size() <= max_body_in_grace);
    if (!permit) throw_without_permit(request);
    watch.lap("queue");
    return permit;
}

api::ReadLimits reading_of(const Request& r, const RouteOptions& options, const api::Stop& stop) {
    // The fields of an identification are copied several times and can be as large as a record.
    const std::size_t points = r.path == "/v1/identify" ? 0 : options.sweep_points;
    return {
        .gives_up = stop.requested,
        .most_numbers = most_numbers,
        .most_other_values = most_outside_record,
        .most_containers = std::max(least_parts, parts_of_a_point * points),
        .most_impacts = most_impacts};
}

/// Calls read(). If it is stopped, nothing is computed that could be returned: a Problem.
template <class Read>
auto read_in_time(
    const Request& r, const Service& service, const Permit& permit, const Read& read) {
    try {
        return read();
    } catch (const api::Cancelled&) {
        if (service.admission.all_stopped()) throw *stopping_refusal().problem;
        if (!permit || r.left()) throw_without_permit(r);
        throw Problem(
            413,
            fmt::format(
                "the server's time limit of {} s for one request was over before all of the body "
                "was read: send a smaller one",
                service.options.deadline));
    }
}

Json body_of(
    const Request& r, const api::ReadLimits& reading,
    api::Columns columns = api::Columns::as_values) {
    if (!r.query.empty())
        throw Problem(400, "a POST takes its fields from the body; the query must be empty");
    return api::parse_object(r.body, reading, columns);
}

/// The fields of an identification's CSV file are in the query, like those of a GET.
api::AnswerRequest asked(const Request& r, const api::ReadLimits& reading) {
    const bool identifies = r.path == "/v1/identify";
    const std::string type = media_type(r.content_type);
    const bool is_columns = identifies && (type == "text/csv" || type == "text/plain");
    const api::FieldTable& table = identifies                 ? api::identify_fields()
                                   : r.path == "/v1/manifold" ? api::manifold_fields()
                                                              : api::simulate_fields();
    const api::Columns columns = identifies ? api::Columns::packed : api::Columns::as_values;
    Json fields = r.method == "POST" && !is_columns ? body_of(r, reading, columns)
                                                    : api::from_query(table, r.query);
    return api::read_answer_request(r.path, std::move(fields), {r.body, is_columns}, reading);
}

const std::pair<std::string, std::string> varies{"Vary", "Accept"};

/// ETag: equal requests to the same build, with the same answer limit, have equal answers. It is
/// computed from what was read, before the computation, so a POST has none.
std::string tag_of(
    const Request& r, api::Format format, std::size_t answer_limit, const std::string& provenance) {
    if (r.method == "POST") return {};
    return entity_tag(fmt::format(
        "{} {} {} {}", api::version(), api::name_of(format).word, answer_limit, provenance));
}

/// The answer's bytes in the requested format. Problem 413 if they exceed the limit; the request's
/// part of the provenance does not count.
std::string encoded(
    api::Answer answer, api::Format format, std::size_t limit, std::size_t provenance,
    const std::function<bool()>& gives_up) {
    try {
        std::string bytes =
            api::encoded(std::move(answer.json), format, answer.provenance, gives_up);
        if (bytes.size() >= large) trim_memory();
        if (bytes.size() <= limit + provenance) return bytes;
        throw Problem(
            413, fmt::format(
                     "the answer has {} bytes, more than this server's limit of {}: request "
                     "fewer parts (include, fields), points (max_points) or impacts (max_impacts)",
                     bytes.size(), limit));
    } catch (const api::Cancelled&) {
        throw_client_left();
    }
}

/// RunControl of a streamed answer: one slot for each run, none while its lists are sent. It
/// releases the slot while requests wait. A started answer is finished even if the server is about
/// to stop.
class StreamPace : public RunControl {
public:
    StreamPace(AdmissionControl& admission, std::string client, Writer& out)
        : admission_(admission),
          client_(std::move(client)),
          out_(out) {}
    void begin() override {
        slot_ = admission_.acquire_background(client_, {});
        while (!slot_ && out_.connected() && !admission_.all_stopped()) {
            slot_ = admission_.acquire(client_);
            if (!slot_) std::this_thread::sleep_for(client_check_interval);  // the queue is full
        }
    }
    void end() override { slot_.reset(); }
    bool stop_or_yield() override {
        if (slot_ && admission_.foreground_waits()) {
            end();
            begin();
        }
        if (const auto now = Stopwatch::Clock::now(); now - checked_ >= client_check_interval) {
            checked_ = now;
            connected_ = out_.connected();
        }
        return !slot_ || !connected_;
    }

private:
    AdmissionControl& admission_;
    const std::string client_;
    Writer& out_;
    AdmissionControl::Slot slot_;
    Stopwatch::Clock::time_point checked_ = Stopwatch::Clock::now();
    bool connected_ = true;
};

// Memory of a run while its lists are made and sent: measured at 5 to 7 MB.
constexpr std::size_t held_by_answer = 8 << 20;

/// Writes an answer whose lists are generated meanwhile. False if it was not written completely.
bool write(
    api::Answer answer, const std::string& client, const std::string& id,
    AdmissionControl& admission, Writer& out) {
    trim_memory();  // the memory of the run
    StreamPace control(admission, client, out);
    try {
        api::write_answer(std::move(answer), control, [&out](std::string_view piece) {
            if (!out.write(piece)) throw api::Cancelled();
        });
        return true;
    } catch (const api::Cancelled&) {
    } catch (...) {
        log_failure("/v1/simulate", id, std::current_exception());
    }
    return false;
}

/// Sends an answer whose lists of impacts are computed meanwhile.
Response stream_answer(api::Answer answer, const Request& request, AdmissionControl& admission) {
    // Shared, because a response can be copied.
    auto shared = std::make_shared<api::Answer>(std::move(answer));
    return {
        .headers = {{"Cache-Control", "no-store"}, varies},
        .stream =
            [shared, client = request.client, id = request.id, &admission](Writer& out) {
                const bool whole = write(std::move(*shared), client, id, admission, out);
                trim_memory();
                return whole;
            },
        .held = held_by_answer,
        .compressible = true};
}

}  // namespace

Response answer(const Request& r, const Service& service, Stopwatch& watch) {
    const RouteOptions& options = service.options;
    AdmissionControl::BodyPermit body_permit =
        body_permit_for(r, service.admission, options.deadline);
    Permit permit = permit_for(r, service.admission, watch);
    const api::Stop stop = stop_conditions(options.deadline, r, service.admission, permit);
    api::AnswerRequest request =
        read_in_time(r, service, permit, [&] { return asked(r, reading_of(r, options, stop)); });
    std::string().swap(r.body);
    std::optional<api::Format>& format = request.form.format;
    if (!format) format = accepted_format(r.accept);
    const std::string provenance = api::describe(request.provenance, nullptr).dump();
    std::string tag = tag_of(r, *format, options.answer_limit, provenance);
    if (!tag.empty() && matches_tag(r.if_none_match, tag))
        return {.status = 304, .tag = tag, .headers = {varies}};
    watch.lap("parse", permit.waited());
    api::Answer answer = api::compute_answer(
        std::move(request), {.stop = stop,
                             .most_bytes = options.answer_limit,
                             .most_kept = options.most_kept_impacts,
                             .most_fitted = most_fitted});
    const bool renewed = permit.renew();
    watch.lap("solve", permit.waited());
    if (!renewed) throw_without_permit(r);
    service.metrics.count_impacts(answer.impacts);
    if (answer.run) return stream_answer(std::move(answer), r, service.admission);
    std::string bytes = encoded(
        std::move(answer), *format, options.answer_limit, provenance.size() + max_hash, r.left);
    body_permit.reset();
    if (stop.requested()) tag = {};  // a repeated request can get further
    Response response{
        .content_type = api::name_of(*format).media_type,
        .body = std::move(bytes),
        .tag = std::move(tag),
        .headers = {varies}};
    if (!compress(response, r, [&] { return !permit.renew() || r.left(); }))
        throw_without_permit(r);
    watch.lap("encode", permit.waited());
    return response;
}

namespace {

/// Reads a request with `read` and streams its lines with `stream`.
template <class Read, class Stream>
Response lines_of(
    const Request& r, const Service& service, Stopwatch& watch, Read read, Stream stream) {
    const RouteOptions& options = service.options;
    const auto body_permit = body_permit_for(r, service.admission, options.deadline);
    Permit permit = permit_for(r, service.admission, watch);  // for reading the request
    const api::Stop stop = stop_conditions(options.deadline, r, service.admission, permit);
    auto request = read_in_time(
        r, service, permit, [&] { return read(body_of(r, reading_of(r, options, stop))); });
    watch.lap("parse", permit.waited());
    return stream(
        std::move(request), options.sweep_deadline, r, service.admission, service.metrics);
}

}  // namespace

Response sweep(const Request& r, const Service& service, Stopwatch& watch) {
    std::optional<api::Format> format;
    const auto read = [&](const Json& body) {
        format = api::sweep_format(body);
        const auto request =
            r.path == "/v1/basins" ? api::read_basins_request : api::read_sweep_request;
        return request(body, service.options.sweep_points);
    };
    const auto stream = [&](api::SweepRequest request, double deadline, auto&... rest) {
        if (!format) format = accepted_format(r.accept, api::sweep_format_names);
        return stream_sweep(
            std::move(request), {*format, service.options.answer_limit}, deadline, rest...);
    };
    Response response = lines_of(r, service, watch, read, stream);
    response.headers.push_back(varies);
    return response;
}

Response continuation(const Request& r, const Service& service, Stopwatch& watch) {
    return lines_of(r, service, watch, api::read_continue_request, stream_continuation);
}

Response design(const Request& r, const Service& service, Stopwatch& watch) {
    return lines_of(r, service, watch, api::read_design_request, stream_design);
}

}  // namespace vines::http
