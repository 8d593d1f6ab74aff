// Request, response and route, independent of the HTTP library.
#pragma once

#include <chrono>
#include <functional>

#include "api/problem.hpp"
#include "http/client.hpp"
#include "http/memory.hpp"

namespace vines::http {

// Interval at which a computation checks whether its client has left.
inline constexpr auto client_check_interval = std::chrono::milliseconds(50);

/// Duration of each phase by name, ms.
using Timing = std::vector<std::pair<std::string, double>>;

inline double in_ms(std::chrono::steady_clock::duration time) {
    return std::chrono::duration<double, std::milli>(time).count();
}

/// Measures the phases of a request's work.
class Stopwatch {
public:
    using Clock = std::chrono::steady_clock;

    /// Ends a phase that began at the previous call. `queued`: time of this and earlier phases that
    /// counts as "queue", which must be the first phase.
    void lap(const char* name, Clock::duration queued = {}) {
        const auto now = Clock::now(), began = std::exchange(last_, now);
        const auto waited = queued - std::exchange(queued_, queued);
        if (!laps_.empty()) laps_[0].second += in_ms(waited);
        laps_.emplace_back(name, in_ms(now - began - waited));
    }
    Timing take() { return std::move(laps_); }

private:
    Clock::time_point last_ = Clock::now();
    Clock::duration queued_{};
    Timing laps_;
};

/// Destination of an answer that is sent in pieces.
class Writer {
public:
    virtual ~Writer() = default;
    virtual bool write(std::string_view text) = 0;  ///< false: the client has left
    virtual bool connected() = 0;                   ///< false once the client has left
};

struct Response {
    int status = 200;
    std::string content_type = "application/json";
    std::string body = {};
    std::string_view gzipped = {};      ///< the compressed body, if precomputed
    std::size_t uncompressed_size = 0;  ///< of a compressed body; 0: it is not compressed
    bool stays_plain = false;           ///< compressing it was given up
    bool immutable = false;             ///< the content of this path never changes
    std::string tag = {};               ///< header ETag; empty: computed from the body
    std::vector<Header> headers = {};
    /// Writes the answer instead of a body; false closes the connection with a reset.
    std::function<bool(Writer&)> stream = {};
    std::size_t held = 0;       ///< bytes a stream holds until its end, approximately
    std::size_t length = 0;     ///< bytes of the stream, approximately; 0: unknown
    bool compressible = false;  ///< the stream can be sent gzipped; after complete(): it is
    /// The stream sends no body until it is computed: a client that has closed its sending side
    /// counts as one that has left.
    bool silent = false;
    /// For an error: the body is made from it when sent.
    std::optional<api::Problem> problem = {};
    Timing timing = {};  ///< header Server-Timing
};

struct Request;

/// The function that answers a method and path.
struct Route {
    std::string method = {};  ///< GET (which includes HEAD) or POST
    std::string path = {};
    std::string name = {};  ///< label in the metrics
    std::function<Response(Request&)> answer = {};
    std::size_t body_limit = 0;  ///< bytes, if larger than the server's limit
    /// Small and without computation: answered by the event loop, however busy the workers are.
    bool on_event_loop = false;
    bool sets_frame_policy = false;  ///< its answers state which pages may show it in a frame
    bool is_public = false;          ///< needs no API key
};

/// A request from its complete head on.
struct Request {
    Head head = {};
    std::string body = {};  ///< a route frees a large one once it is read
    Sender sender = {};
    std::string id = {};  ///< see request_id()
    /// Returns true once the client has left.
    std::function<bool()> left = [] { return false; };
    /// Returns true while another client's request waits for a thread, of which this one has more;
    /// with true, also if this is its client's only one.
    std::function<bool(bool)> others_need_threads = [](bool) { return false; };
    /// MemoryBudget::must_wait() and reserve() for the answer.
    std::function<bool(MemoryBudget::Bytes, MemoryBudget::Clock::time_point)>
        awaits_memory = [](auto, auto) { return false; },
        reserve_memory = [](auto, auto) { return true; };
    const Route* route = nullptr;                      ///< can be null if refused
    std::optional<Response> refused = {};              ///< its connection is then read no further
    std::chrono::steady_clock::time_point since = {};  ///< time at which the request was complete
};

/// A problem document (RFC 9457) as a response; 503 with Retry-After. Its body, which contains the
/// request's id, is made when it is sent.
inline Response problem_response(const api::Problem& problem) {
    Response response{
        .status = problem.status, .content_type = "application/problem+json", .problem = problem};
    if (problem.status == 503) response.headers.emplace_back("Retry-After", "1");
    return response;
}
inline Response problem_response(
    int status, const std::string& detail, std::vector<Header> headers = {}) {
    Response response = problem_response(api::Problem(status, detail));
    response.headers = std::move(headers);
    return response;
}

// Largest answer sent even when the memory budget is used up, bytes: the number of connections
// bounds these.
inline constexpr std::size_t small_answer = 1 << 16;
/// 503: the memory limit is reached.
inline Response memory_refusal() {
    return problem_response(api::Problem::unavailable(
        "memory", "the server has reached its memory limit for requests and answers"));
}
/// 503: the server is stopping; the request can be sent to another server.
inline Response stopping_refusal() {
    return problem_response(api::Problem::unavailable("stopping", "the server is stopping"));
}

}  // namespace vines::http
