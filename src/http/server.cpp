#include "http/server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

#include "http/log.hpp"
#include "http/problem_response.hpp"
#include "http/refusal.hpp"
#include "http/send.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;
using Handled = httplib::Server::HandlerResponse;

constexpr int backlog = 512;  // httplib's own is 5: of 400 clients at once some would be refused

/// httplib keeps its listening socket to itself and its subclasses.
class ListeningServer : public httplib::Server {
public:
    void widen_backlog() { ::listen(svr_sock_, backlog); }
};

/// The query of a request's target. (The library's own splits a pair at its last "=", and would
/// read b=1=2 as b = 2.)
std::string_view query_of(std::string_view target) {
    const std::size_t mark = target.find('?');
    if (mark == std::string_view::npos) return {};
    const std::string_view query = target.substr(mark + 1);
    return query.substr(0, query.find('#'));
}

Request to_request(const httplib::Request& in, std::string body) {
    return {
        .method = in.method,
        .path = in.path,
        .query = api::parse_query(query_of(in.target)),
        .content_type = in.get_header_value("Content-Type"),
        .body = std::move(body)};
}

/// A path as the regular expression that the library takes.
std::string pattern_of(const std::string& path) {
    std::string pattern;
    for (char c : path) {
        if (std::strchr(".+*?^$()[]{}|\\", c)) pattern += '\\';
        pattern += c;
    }
    return pattern;
}

/// Answers that the library makes itself (a malformed request line, headers too long) have no body
/// of ours yet.
Handled explain(const httplib::Request& in, httplib::Response& out) {
    if (!out.has_header("Content-Type"))
        send(in, out, problem_response(out.status, "the request could not be read"));
    return Handled::Handled;
}

void fail(const httplib::Request& in, httplib::Response& out, const std::exception_ptr& thrown) {
    log_failure(in.path, thrown);
    send(
        in, out, problem_response(500, "the server failed at this request; its log says why"),
        true);
}

}  // namespace

struct Server::Implementation {
    ServerOptions options;
    std::vector<Route> routes;
    ListeningServer http;
    std::atomic<int> in_work = 0;

    /// The request that this I/O thread works on. The library has no place for it in its own
    /// structs, but takes a request from its head to its log line on one thread, one after the
    /// other.
    struct InWork {
        bool counted = false;
        Clock::time_point since;
    };
    static InWork& current() {
        thread_local InWork work;
        return work;
    }

    std::size_t limit_of(const httplib::Request& in) const {
        const Route* route = find_route(routes, in.method, in.path);
        return std::max(options.payload_limit, route ? route->body_limit : 0);
    }

    Handled before_routing(const httplib::Request& in, httplib::Response& out) {
        current() = {true, Clock::now()};
        ++in_work;
        if (std::optional<Response> refused = refusal(in, routes, limit_of(in))) {
            const bool close = !in.ranges.empty() || in.has_header("Content-Length") ||
                               in.has_header("Transfer-Encoding");
            // The library would cut this answer up, too.
            const_cast<httplib::Request&>(in).ranges.clear();
            send(in, out, std::move(*refused), close);
            return Handled::Handled;
        }
        if (in.method == "POST") return Handled::Unhandled;  // the body comes next
        answer(in, out, "");
        return Handled::Handled;
    }

    void answer(const httplib::Request& in, httplib::Response& out, std::string body) {
        Response response =
            find_route(routes, in.method, in.path)->answer(to_request(in, std::move(body)));
        if (response.stream) send_stream(in, out, std::move(response));
        else send(in, out, std::move(response));
    }

    /// Reads the body as it is: read by the library, one of the type that curl -d sends would be
    /// parsed as a form and be refused above 8 kB.
    void post(
        const httplib::Request& in, httplib::Response& out, const httplib::ContentReader& read) {
        std::string body;
        const std::size_t limit = limit_of(in);
        bool too_long = false;
        const bool complete = read([&](const char* data, std::size_t size) {
            // What is too large is read to its end, so that the client gets to read the answer.
            too_long = too_long || body.size() + size > limit;
            if (!too_long) body.append(data, size);
            return true;
        });
        if (out.status == 413 || too_long) return send(in, out, body_too_large(limit), true);
        if (!complete)
            return send(
                in, out, problem_response(400, "the body ended before its Content-Length"), true);
        answer(in, out, std::move(body));
    }

    void log(const httplib::Request& in, const httplib::Response& out) {
        InWork& work = current();
        const std::chrono::duration<double, std::milli> taken =
            work.counted ? Clock::now() - work.since : Clock::duration(0);
        log_served(
            {.method = in.method,
             .path = in.path,
             .status = out.status,
             .ms = taken.count(),
             .bytes = out.content_length_});
        if (work.counted) --in_work;
        work.counted = false;
    }

    void set_connections() {
        http.new_task_queue = [threads = options.threads] {
            return new httplib::ThreadPool(threads);
        };
        // Not the library's SO_REUSEPORT: with that a second server on the same port starts without
        // a word and takes half of the requests.
        http.set_socket_options([](auto socket) {
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        http.set_tcp_nodelay(true);
        http.set_keep_alive_max_count(1000);
        http.set_keep_alive_timeout(5);  // s, as the others
        http.set_read_timeout(10);
        http.set_write_timeout(30);
        std::size_t largest = options.payload_limit;
        for (const Route& route : routes) largest = std::max(largest, route.body_limit);
        http.set_payload_max_length(largest);
    }

    void set_handlers() {
        http.set_pre_routing_handler(
            [this](const auto& in, auto& out) { return before_routing(in, out); });
        for (const Route& route : routes)
            if (route.method == "POST")
                http.Post(
                    pattern_of(route.path),
                    [this](const auto& in, auto& out, const auto& read) { post(in, out, read); });
        http.set_exception_handler(fail);
        http.set_error_handler(httplib::Server::HandlerWithResponse(explain));
        http.set_logger([this](const auto& in, const auto& out) { log(in, out); });
    }
};

Server::Server(const ServerOptions& options, std::vector<Route> routes)
    : implementation_(std::make_unique<Implementation>()) {
    implementation_->options = options;
    implementation_->routes = std::move(routes);
    implementation_->set_connections();
    implementation_->set_handlers();
}

Server::~Server() = default;

int Server::bind() {
    const ServerOptions& options = implementation_->options;
    ListeningServer& http = implementation_->http;
    errno = 0;
    int port = options.port;
    const bool bound = port == 0 ? (port = http.bind_to_any_port(options.host)) > 0
                                 : http.bind_to_port(options.host, port);
    if (!bound)
        throw std::runtime_error(fmt::format(
            "cannot listen on {}:{}{}{}", options.host, options.port, errno ? ": " : "",
            errno ? std::strerror(errno) : ""));
    http.widen_backlog();
    return port;
}

void Server::run() { implementation_->http.listen_after_bind(); }

void Server::stop() {
    // The library cuts answers off in the middle when it stops, so let those in work finish first.
    const auto latest = Clock::now() + std::chrono::seconds(10);
    while (implementation_->in_work > 0 && Clock::now() < latest)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    implementation_->http.stop();
}

}  // namespace vines::http
