#include "http/server.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <list>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "http/event_loop.hpp"
#include "http/head.hpp"
#include "http/log.hpp"
#include "http/memory.hpp"
#include "http/message.hpp"
#include "http/send.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;
using Handled = httplib::Server::HandlerResponse;

// httplib's default of 5 would refuse some of 400 simultaneous clients.
constexpr int backlog = 512;

// Largest answer sent even when the memory budget is used up, bytes; one per worker at most.
constexpr std::size_t small_answer = 1 << 20;

// From this size on the memory of a body, several times its size, is returned to the system at
// once. That takes as long as to read a part of it. Bytes.
constexpr std::size_t large_body = 1 << 20;

/// httplib's part: it creates the listening socket and writes answers.
class Engine : public httplib::Server {
public:
    int listening() { return svr_sock_; }
    void widen_backlog() { ::listen(svr_sock_, backlog); }
    bool answer(httplib::Stream& stream) { return process(*this, stream); }

private:
    /// Later versions of httplib also take the addresses.
    template <class Self>
    static bool process(Self& self, httplib::Stream& stream) {
        bool closed = false;
        if constexpr (requires { self.process_request(stream, false, closed, nullptr); })
            return self.process_request(stream, false, closed, nullptr);
        else return self.process_request(stream, "", 0, "", 0, false, closed, nullptr);
    }
};

/// Reason and remedy. error: errno, or 0 if unknown.
std::string why_not_bound(const ServerOptions& options, int error) {
    constexpr const char* other_port = "use --port, or --port 0 for any free one";
    if (error == EADDRINUSE) return fmt::format("port {} is taken; {}", options.port, other_port);
    if (error == EACCES)
        return fmt::format("port {} needs privileges; {}", options.port, other_port);
    if (error == 0 || error == EADDRNOTAVAIL)
        return fmt::format(
            "cannot listen on {}; use --host with an address of this machine", options.host);
    return fmt::format(
        "cannot listen on {}:{}: {}", in_url(options.host), options.port, std::strerror(error));
}

}  // namespace

struct Server::Implementation {
    Implementation(ServerOptions options_, std::vector<Route> routes_, Metrics& metrics_)
        : options(std::move(options_)),
          routes(std::move(routes_)),
          metrics(metrics_) {}

    ServerOptions options;
    std::vector<Route> routes;
    Metrics& metrics;
    /// Answer to a CORS preflight; the content is in its headers.
    const Route preflight = {
        .name = "preflight",
        .answer = [](const Request&) { return Response{.body = "{}\n"}; },
        .on_event_loop = true};
    Engine http;
    std::optional<EventLoop> event_loop;
    std::atomic<bool> closing = false;

    /// The request that a thread is answering. httplib calls back into the server meanwhile, and
    /// its own structs cannot carry this.
    struct ActiveRequest {
        Connection* connection = nullptr;
        Exchange exchange;
        SocketStream* stream = nullptr;
        std::string id = {};
        int status = 0;
        std::string lacking = {};
        Timing timing = {};
        bool keep_alive = false;  ///< the connection can be reused
    };
    /// The active requests of all threads. Other threads read only members that stay constant while
    /// the request is in the list.
    std::mutex mutex;
    std::list<const ActiveRequest*> active;

    class Registration {
    public:
        Registration(Implementation& server, const ActiveRequest& work) : server_(server) {
            const std::lock_guard lock(server_.mutex);
            at_ = server_.active.insert(server_.active.end(), &work);
        }
        ~Registration() {
            const std::lock_guard lock(server_.mutex);
            server_.active.erase(at_);
        }
        Registration(const Registration&) = delete;
        Registration& operator=(const Registration&) = delete;

    private:
        Implementation& server_;
        std::list<const ActiveRequest*>::iterator at_;
    };

    static ActiveRequest& current() {
        thread_local ActiveRequest work;
        return work;
    }

    /// Fills in the response to the request of this thread.
    void respond(const httplib::Request& in, httplib::Response& out) {
        ActiveRequest& work = current();
        work.keep_alive = work.exchange.head.keep_alive && !work.exchange.refused;
        Response response = response_to(work);
        const std::size_t size = std::max(response.body.size(), response.uncompressed_size);
        if (size + response.held > small_answer && event_loop->memory().is_full())
            response = memory_refusal();
        for (auto& header : cors_headers(work.exchange.head, options.access))
            response.headers.push_back(std::move(header));
        work.connection->hold(response.body.size() + response.held);
        // Without chunks only the end of the connection marks the end of a stream.
        if (response.stream && !work.exchange.head.takes_chunks) work.keep_alive = false;
        work.timing = response.timing;
        if (response.problem) work.lacking = response.problem->lacking;
        send(work.exchange.head, work.id, out, std::move(response));
        work.status = out.status;
        // httplib announces the close if the request asks for it.
        if (closing) work.keep_alive = false;
        if (!work.keep_alive) const_cast<httplib::Request&>(in).set_header("Connection", "close");
    }

    Response response_to(ActiveRequest& work) const {
        Exchange& exchange = work.exchange;
        if (exchange.refused) return std::move(*exchange.refused);
        const std::size_t size = exchange.body.size();
        Response response = answer_of_route(work);
        if (size >= large_body) trim_memory();
        return response;
    }

    Response answer_of_route(ActiveRequest& work) const {
        Exchange& exchange = work.exchange;
        const Head& head = exchange.head;
        try {
            return exchange.route->answer(
                {.method = head.method,
                 .path = std::string(head.path()),
                 .query = api::parse_query(head.query()),
                 .content_type = std::string(head.header("content-type")),
                 .body = std::move(exchange.body),
                 .accept = std::string(head.header("accept")),
                 .accept_encoding = std::string(head.header("accept-encoding")),
                 .if_none_match = std::string(head.header("if-none-match")),
                 .id = work.id,
                 .left = [&work] { return work.stream->has_left(); }});
        } catch (...) {
            log_failure(std::string(head.path()), work.id, std::current_exception());
            return problem_response(500, "the server failed; the reason is in its log");
        }
    }

    /// The log entry of a request, as far as it is known before the answer.
    static ServedRequest begin_log_entry(const ActiveRequest& work) {
        const Exchange& exchange = work.exchange;
        const std::chrono::duration<double, std::milli> taken = Clock::now() - exchange.since;
        return {
            .id = work.id,
            .client = work.connection->client(),
            .method = exchange.head.method,
            .path = std::string(exchange.head.path()),
            .route = exchange.route ? exchange.route->name : "none",
            .ms = taken.count()};
    }

    /// False if the answer was broken off.
    bool write_registered(const ActiveRequest& work) {
        const Registration entry(*this, work);
        return write(*work.stream) && work.stream->finish();
    }
    bool write(SocketStream& stream) {
        try {
            return http.answer(stream);
        } catch (...) {  // thrown by an answer that is made while it is sent
            log_failure(
                std::string(current().exchange.head.path()), current().id,
                std::current_exception());
            return false;
        }
    }

    /// Answers one request; true if the connection can be reused.
    bool answer(Connection& connection, Exchange exchange, WriteTimeout timeout) {
        // httplib needs to know only this of the request: an answer to a HEAD has no body.
        const char* method = exchange.head.method == "HEAD" ? "HEAD" : "GET";
        SocketStream stream(
            connection, fmt::format("{} / HTTP/1.1\r\n\r\n", method), std::move(timeout));
        ActiveRequest& work = current();
        std::string id = request_id(exchange.head);
        work = {&connection, std::move(exchange), &stream, std::move(id)};
        const bool sent = write_registered(work);
        const bool keep_alive = sent && work.keep_alive;
        if (!sent) connection.abort();
        ServedRequest served = begin_log_entry(work);
        served.lacking = work.lacking;
        served.status = work.status;
        served.timing = work.timing;
        served.bytes = stream.written();
        served.left = !sent;
        log_request(served);
        metrics.count_served(served);
        work = {};
        return keep_alive;
    }

    CheckedHead check_head(const Head& head) const {
        CheckedHead checked{.route = find_route(routes, head.method, head.path())};
        checked.refused = access_refusal(head, checked.route, options.access);
        if (!checked.refused && is_preflight(head, options.access)) checked.route = &preflight;
        if (!checked.refused)
            checked.refused = request_refusal(head, checked.route, routes, options.payload_limit);
        return checked;
    }

    Handlers handlers() {
        return {
            .check_head = [this](const Head& head) { return check_head(head); },
            .answer =
                [this](Connection& connection, Exchange exchange, WriteTimeout timeout) {
                    return answer(connection, std::move(exchange), std::move(timeout));
                }};
    }
};

Server::Server(const ServerOptions& options, std::vector<Route> routes, Metrics& metrics)
    : implementation_(std::make_unique<Implementation>(options, std::move(routes), metrics)) {
    Engine& http = implementation_->http;
    http.set_keep_alive_timeout(idle_time.count());  // announced to clients
    http.set_keep_alive_max_count(1000000);
    http.set_pre_routing_handler([this](const auto& in, auto& out) {
        implementation_->respond(in, out);
        return Handled::Handled;
    });
    // httplib would state Content-Length: 0, which is not the length of the known answer.
    http.set_post_routing_handler([](const auto&, auto& out) {
        if (out.status == 304) out.headers.erase("Content-Length");
    });
    // Replaces httplib's SO_REUSEPORT: with it a second server on the same port would start without
    // an error and take half of the requests.
    http.set_socket_options([](auto socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
}

Server::~Server() = default;

int Server::bind() {
    const ServerOptions& options = implementation_->options;
    Engine& http = implementation_->http;
    errno = 0;
    int port = options.port;
    const bool bound = port == 0 ? (port = http.bind_to_any_port(options.host)) > 0
                                 : http.bind_to_port(options.host, port);
    if (!bound) throw std::runtime_error(why_not_bound(options, errno));
    http.widen_backlog();
    implementation_->event_loop.emplace(
        http.listening(),
        ConnectionLimits{
            .connections = options.connections,
            .workers = options.threads,
            .waiting = static_cast<std::size_t>(options.threads),
            .held_bytes = options.memory_limit},
        implementation_->handlers());
    implementation_->metrics.watch_connections(
        [this] { return implementation_->event_loop->load(); });
    return port;
}

void Server::run() { implementation_->event_loop->run(); }

void Server::close_connections() { implementation_->closing = true; }

void Server::stop() {
    close_connections();
    implementation_->event_loop->stop();
}

std::size_t Server::log_unanswered() {
    const std::size_t number = implementation_->event_loop->load().in_flight;
    const std::lock_guard lock(implementation_->mutex);
    for (const auto* work : implementation_->active)
        http::log_unanswered(Implementation::begin_log_entry(*work));
    return number;
}

}  // namespace vines::http
