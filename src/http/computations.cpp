#include "http/routes.hpp"

#include "api/continuation.hpp"
#include "api/design.hpp"
#include "api/format/answer_request.hpp"
#include "api/parse.hpp"
#include "api/schema/tables.hpp"
#include "api/version.hpp"
#include "http/encoding.hpp"
#include "http/memory.hpp"

namespace vines::http {

namespace {

using api::Json;
using api::Problem;

// Extra time, as a fraction of the deadline, for analysing a run that was cut off (first half) and
// for writing its answer.
constexpr double time_to_write = 0.2;

// Answers from this size on return their memory to the system at once, bytes.
constexpr std::size_t large = 16 << 20;

// The memory of a run's lists is at least this many times the size of a binary answer above 16 MiB,
// and at least that of a text.
constexpr std::size_t over_binary = 3;

// Largest body that is read in a small part of the grace period, bytes.
constexpr std::size_t max_body_in_grace = 16 << 10;

// Starts of a sweep take 90 times their size while they are read: bodies of all routes but
// /v1/identify count this many times.
constexpr std::size_t weight_of_fields = 16;

// A list of impacts in JSON takes 45 times its size, a record in a table five times.
constexpr std::size_t weight_of_lists = 10;

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

// Time after which a request, with all its waiting, ends as at its deadline if others need its
// thread (twice the time if its client has no other) or, where memory lacks for turns, its slot. A
// fraction is left to finish the answer.
constexpr std::chrono::duration<double> age_in_need(5);

/// Ends the request of a client that has left; only the log shows its status.
[[noreturn]] void throw_client_left() { throw Problem(499, "the client has left"); }

/// True if a record is a table of text, not JSON.
bool is_table(const Request& r) {
    const std::string type = media_type(r.head.header("content-type"));
    return type == "text/csv" || type == "text/plain";
}

/// A request that computes: its permits and its deadline.
class Computing {
public:
    /// Waits for the permit of a large body, then for the permit to compute: waiting requests hold
    /// no slot. Problem 503 if there is none.
    Computing(const Request& request, const Service& service, Stopwatch& watch)
        : request_(request),
          service_(service),
          watch_(watch),
          body_permit_(wait_for_body_permit()),
          permit_(
              service.admission, request.sender.client(), request.left,
              request.body.size() <= max_body_in_grace, body_bytes_ > immediate_body) {
        if (!permit_) throw_without();
        watch.lap("queue");
    }

    /// Returns read(limits). If it is stopped, nothing is computed that could be returned: a
    /// Problem.
    template <class Read>
    auto read(const Read& read) {
        // The fields of an identification are copied several times and can be as large as a record.
        const std::size_t points = identifies() ? 0 : service_.options.sweep_points;
        try {
            auto request = read(
                {.gives_up = stop().requested,
                 .most_numbers = most_numbers,
                 .most_other_values = most_outside_record,
                 .most_containers = std::max(least_parts, parts_of_a_point * points),
                 .most_impacts = most_impacts});
            if (!identifies()) permit_.end_urgency();
            return request;
        } catch (const api::Cancelled&) {
            if (!permit_ || is_unwanted()) throw_without();
            refuse_if_needed();
            throw Problem(
                413, fmt::format(
                         "the server's time limit of {} s for one request was over before it was "
                         "read: send a smaller one",
                         service_.options.deadline));
        }
    }
    /// The problem of a request that ended early since others need what it had.
    void refuse_if_needed() const {
        if (needed_)
            throw Problem::unavailable(
                "threads", "it takes long, and others need its thread or memory; try again later");
    }
    /// Conditions that end the computation; this object must outlive them.
    api::Stop stop() {
        return {
            .requested = [this] { return is_over(1); },
            .analysis_late = [this] { return is_over(1 + time_to_write / 2); },
            .late = [this] { return is_over(1 + time_to_write); }};
    }
    /// Ends a phase.
    void lap(const char* name) { watch_.lap(name, permit_.waited()); }
    bool renew() { return permit_.renew(); }  ///< see Permit
    /// To be called once the body is read, or, since its record is kept, once it is identified.
    void release_body() { body_permit_.reset(); }
    /// Waits for the permit to hold lists with a text of these bytes, unless they are few or it has
    /// one; before it, if given, for memory for the answer, which is reserved with it.
    void wait_for_lists(std::size_t bytes, std::size_t answer = 0) {
        const bool needs_permit = bytes > immediate_lists && !lists_permit_;
        const Clock::time_point since = Clock::now();
        const auto wait = [&] {
            do {
                lists_permit_.reset();
                wait_for_memory({answer}, since);
                if (needs_permit)
                    lists_permit_ = service_.admission.acquire_lists(
                        request_.sender.client(), bytes, [this] { return is_unwanted(); });
            } while (lacks_memory({answer}, since));
            if (answer > 0) request_.reserve_memory({answer}, since);
            return needs_permit ? lists_permit_ != nullptr : !is_unwanted();
        };
        if (needs_permit || lacks_memory({answer}, since)) {
            if (!permit_.wait_without_slot(wait)) throw_without();
            listed_ = Clock::now();
        } else if (answer > 0) request_.reserve_memory({answer}, since);
    }
    /// Gives back what the lists have, and waits for memory for a stream, which is reserved.
    void wait_for_stream(std::size_t bytes) {
        const Clock::time_point since = Clock::now();
        lists_permit_.reset();
        request_.reserve_memory({}, since);
        permit_.wait_without_slot([&] {
            wait_for_memory({bytes, bytes}, since);
            return false;
        });
        request_.reserve_memory({bytes, bytes}, since);
    }
    /// Whether the lists are to be freed for others.
    bool others_need_lists() const {
        const Clock::time_point now = Clock::now();
        return service_.admission.others_need(
            lists_permit_, request_.sender.client(), now - listed_,
            now - began_ - permit_.waited());
    }

    /// Ends a request that has no permit: its client has left, or a full queue had no place.
    [[noreturn]] void throw_without(
        const char* what = "computing",
        const std::string& reason = "the queue for computing is full") const {
        if (request_.left()) throw_client_left();
        if (service_.admission.all_stopped()) throw *stopping_refusal().problem;
        throw Problem::unavailable(what, reason + "; try again in a second");
    }

private:
    using Clock = Stopwatch::Clock;

    /// Whether it is to wait, since this time, for memory for these bytes of the answer. If it
    /// gives up, the answer can be refused.
    bool lacks_memory(MemoryBudget::Bytes bytes, Clock::time_point since) const {
        return request_.awaits_memory(bytes, since) &&
               Clock::now() < since + longest_wait_for_memory && !is_unwanted() &&
               !request_.others_need_threads(false);
    }
    void wait_for_memory(MemoryBudget::Bytes bytes, Clock::time_point since) const {
        while (lacks_memory(bytes, since)) std::this_thread::sleep_for(client_check_interval / 4);
    }
    bool is_unwanted() const { return request_.left() || service_.admission.all_stopped(); }
    /// The size of a body for its permit.
    std::size_t weighted(std::size_t bytes) const {
        if (!identifies()) return bytes * weight_of_fields;
        return bytes > immediate_body && !is_table(request_) ? bytes * weight_of_lists : bytes;
    }
    bool identifies() const { return request_.head.path() == "/v1/identify"; }

    AdmissionControl::SizePermit wait_for_body_permit() const {
        AdmissionControl& admission = service_.admission;
        // One turn of another client, which parses and has a deadline, and more.
        const std::chrono::duration<double> longest(2 * service_.options.deadline);
        auto permit = admission.acquire_body(
            request_.sender.client(), body_bytes_, identifies(),
            [this, deadline = Clock::now() + longest] {
                return is_unwanted() || Clock::now() > deadline;
            });
        if (!permit) throw_without("memory", "other large bodies are being read");
        return permit;
    }

    /// True after this multiple of the deadline, without the time in which the permit waits; after
    /// 5 or 10 s if others need what it has (age_in_need); without a permit; once the client has
    /// left; or if the server stops. One thread at a time.
    bool is_over(double fraction) {
        if (!permit_.renew()) return true;
        const auto now = Clock::now();
        if (now - checked_ > client_check_interval) {
            checked_ = now;
            is_abandoned_ = is_unwanted();
            if (!needed_ && others_need_it(now - began_)) needed_ = now;
        }
        const std::chrono::duration<double> time(fraction * service_.options.deadline);
        return is_abandoned_ || now - permit_.waited() > began_ + time ||
               (needed_ && now >= *needed_ + (fraction - 1) * age_in_need);
    }

    bool others_need_it(Clock::duration age) const {
        const std::string client = request_.sender.client();
        return (age > age_in_need && (request_.others_need_threads(age > 2 * age_in_need) ||
                                      service_.admission.others_are_stuck(client))) ||
               others_need_lists() ||
               service_.admission.others_need(body_permit_, client, age, age - permit_.waited());
    }

    const Request& request_;
    const Service& service_;
    Stopwatch& watch_;
    const std::size_t body_bytes_ = weighted(request_.body.size());
    AdmissionControl::SizePermit body_permit_, lists_permit_;
    Permit permit_;
    const Clock::time_point began_ = Clock::now();
    Clock::time_point checked_ = began_, listed_;  // listed_: since when it has the lists' permit
    bool is_abandoned_ = false;
    std::optional<Clock::time_point> needed_;  // by others, from age_in_need on
};

Json body_of(
    const Request& r, const api::ReadLimits& reading,
    api::Columns columns = api::Columns::as_values) {
    if (!api::parse_query(r.head.query()).empty())
        throw Problem(400, "a POST takes its fields from the body; the query must be empty");
    return api::parse_object(r.body, reading, columns);
}

/// The fields of an identification's CSV file are in the query, like those of a GET.
api::AnswerRequest asked(const Request& r, const api::ReadLimits& reading) {
    const std::string route(r.head.path());
    const bool identifies = route == "/v1/identify";
    const bool is_columns = identifies && is_table(r);
    const api::FieldTable& table = identifies                ? api::identify_fields()
                                   : route == "/v1/manifold" ? api::manifold_fields()
                                                             : api::simulate_fields();
    const api::Columns columns = identifies ? api::Columns::packed : api::Columns::as_values;
    Json fields = r.head.method == "POST" && !is_columns
                      ? body_of(r, reading, columns)
                      : api::from_query(table, api::parse_query(r.head.query()));
    return api::read_answer_request(route, std::move(fields), {r.body, is_columns}, reading);
}

const std::pair<std::string, std::string> varies{"Vary", "Accept"};

/// ETag: equal requests to the same build, with the same answer limit, have equal answers. It is
/// computed from what was read, before the computation, so a POST has none.
std::string tag_of(
    const Request& r, api::Format format, std::size_t answer_limit, const std::string& provenance) {
    if (r.head.method == "POST") return {};
    return entity_tag(fmt::format(
        "{} {} {} {}", api::version(), api::name_of(format).word, answer_limit, provenance));
}

/// The answer's bytes in the requested format. Problem 413 if they exceed the limit; the request's
/// part of the provenance does not count.
std::string encoded(
    api::Answer answer, api::Format format, std::size_t limit, std::size_t provenance,
    const std::function<bool()>& gives_up) {
    const auto check = [&](std::size_t bytes, const char* at_least) {
        if (bytes <= limit + provenance) return;
        throw Problem(
            413, fmt::format(
                     "the answer has {}{} bytes, more than this server's limit of {}: request "
                     "fewer parts (include, fields), points (max_points) or impacts (max_impacts)",
                     at_least, bytes, limit));
    };
    try {
        // Encoding takes several times their size.
        if (format == api::Format::cbor || format == api::Format::npz)
            check(api::packed_bytes(answer.json), "at least ");
        std::string bytes =
            api::encoded(std::move(answer.json), format, answer.provenance, gives_up);
        if (bytes.size() >= large) trim_memory();
        check(bytes.size(), "");
        return bytes;
    } catch (const api::Cancelled&) {
        throw_client_left();
    }
}

/// The request that read(json, gives_up) makes of the body.
template <class Read>
auto read_body(const Request& r, const Service& service, Stopwatch& watch, const Read& read) {
    Computing computing(r, service, watch);
    auto request = computing.read(
        [&](const api::ReadLimits& limits) { return read(body_of(r, limits), limits.gives_up); });
    computing.lap("parse");
    return request;
}

}  // namespace

Response answer(Request& r, const Service& service, Stopwatch& watch) {
    const RouteOptions& options = service.options;
    Computing computing(r, service, watch);
    api::AnswerRequest request =
        computing.read([&r](const api::ReadLimits& limits) { return asked(r, limits); });
    std::string().swap(r.body);
    if (!std::holds_alternative<api::IdentifyRequest>(request.computation))
        computing.release_body();
    std::optional<api::Format>& format = request.form.format;
    if (!format) format = accepted_format(r.head.header("accept"));
    const std::string provenance = api::describe(request.provenance, nullptr).dump();
    std::string tag = tag_of(r, *format, options.answer_limit, provenance);
    if (!tag.empty() && matches_tag(r.head.header("if-none-match"), tag))
        return {.status = 304, .tag = tag, .headers = {varies}};
    computing.lap("parse");
    const api::Stop stop = computing.stop();
    const bool is_binary = *format == api::Format::cbor || *format == api::Format::npz;
    const api::ComputeOptions limits{
        .stop = stop,
        .most_bytes = options.answer_limit,
        .most_kept = options.most_kept_impacts,
        .most_fitted = most_fitted,
        .begins = [&](std::size_t text) {
            computing.wait_for_lists(text, text / (is_binary ? over_binary : 1));
        }};
    api::Answer answer;
    try {
        answer = api::compute_answer(std::move(request), limits);
    } catch (const Problem&) {
        computing.refuse_if_needed();
        throw;
    }
    const bool renewed = computing.renew();
    computing.lap("solve");
    if (!renewed) computing.throw_without();
    service.metrics.count_runs(0, static_cast<std::size_t>(answer.impacts));
    if (answer.run) {
        Response response = stream_answer(std::move(answer), r, service);
        computing.wait_for_stream(response.held);
        response.headers.push_back(varies);
        return response;
    }
    computing.wait_for_lists(3 * api::packed_bytes(answer.json));  // about the bytes of its text
    const auto ends = [&] { return r.left() || !computing.renew(); };
    std::string bytes = encoded(
        std::move(answer), *format, options.answer_limit, provenance.size() + max_hash, ends);
    computing.release_body();
    if (stop.requested()) tag = {};  // a repeated request can get further
    Response response{
        .content_type = api::name_of(*format).media_type,
        .body = std::move(bytes),
        .tag = std::move(tag),
        .headers = {varies}};
    const auto gives_up = [&] { return ends() || computing.others_need_lists(); };
    // Lists that others need are sent as they are.
    if (!compress(response, r, gives_up) && ends()) computing.throw_without();
    computing.lap("encode");
    return response;
}

Response sweep(Request& r, const Service& service, Stopwatch& watch) {
    std::optional<api::Format> format;
    api::SweepRequest request =
        read_body(r, service, watch, [&](const Json& body, const auto& ends) {
            format = api::format_in(body, api::sweep_format_names);
            const auto read =
                r.head.path() == "/v1/basins" ? api::read_basins_request : api::read_sweep_request;
            return read(body, service.options.sweep_points, api::CancelCheck(ends));
        });
    if (!format) format = accepted_format(r.head.header("accept"), api::sweep_format_names);
    Response response = stream_sweep(std::move(request), *format, r, service);
    response.headers.push_back(varies);
    return response;
}

Response continuation(Request& r, const Service& service, Stopwatch& watch) {
    const auto read = [](const Json& body, const auto&) {
        return api::read_continue_request(body);
    };
    return stream_lines(api::continuation_lines(read_body(r, service, watch, read)), r, service);
}

Response design(Request& r, const Service& service, Stopwatch& watch) {
    return stream_lines(
        api::design_lines(read_body(r, service, watch, api::read_design_request)), r, service);
}

}  // namespace vines::http
