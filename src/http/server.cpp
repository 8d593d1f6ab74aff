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

#include "http/connections.hpp"
#include "http/log.hpp"
#include "http/memory.hpp"
#include "http/problem_response.hpp"
#include "http/refusal.hpp"
#include "http/request_id.hpp"
#include "http/send.hpp"
#include "http/socket_stream.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;
using Handled = httplib::Server::HandlerResponse;

constexpr int backlog = 512;  // httplib's own is 5: of 400 clients at once some would be refused

// Is always sent: there are no more than threads.
constexpr std::size_t small_answer = 1 << 20;

// From this size on the memory that a body took, some times as much as itself, is given back to the
// system at once: that takes as long as to read some of it.
constexpr std::size_t large_body = 1 << 20;

/// What httplib is here for: it makes the listening socket, and writes answers.
class Engine : public httplib::Server {
public:
    int listening() { return svr_sock_; }
    void widen_backlog() { ::listen(svr_sock_, backlog); }
    bool answer(httplib::Stream& stream) { return process(*this, stream); }

private:
    /// Its later versions want the addresses, too.
    template <class Self>
    static bool process(Self& self, httplib::Stream& stream) {
        bool closed = false;
        if constexpr (requires { self.process_request(stream, false, closed, nullptr); })
            return self.process_request(stream, false, closed, nullptr);
        else return self.process_request(stream, "", 0, "", 0, false, closed, nullptr);
    }
};

/// With what may help. error: errno, 0 where the system does not say.
std::string why_not_bound(const ServerOptions& options, int error) {
    constexpr const char* other_port = "use --port, or --port 0 for any free one";
    if (error == EADDRINUSE) return fmt::format("port {} is taken; {}", options.port, other_port);
    if (error == EACCES)
        return fmt::format("port {} is not for everyone; {}", options.port, other_port);
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
    /// What it says stands in its headers.
    const Route preflight = {
        .name = "preflight",
        .answer = [](const Request&) { return Response{.body = "{}\n"}; },
        .light = true};
    Engine http;
    std::optional<Connections> connections;
    std::atomic<bool> closing = false;

    /// What a thread answers. The library calls back while it does, and has no place for it in its
    /// own structs.
    struct InWork {
        Connection* connection = nullptr;
        Exchange exchange;
        SocketStream* stream = nullptr;
        std::string id = {};
        int status = 0;
        std::string lacking = {};
        Timing timing = {};
        bool keeps = false;  ///< the connection, for another request
    };
    /// Those of all threads. Of each, what is read of it by others stays as it is until it is out.
    std::mutex mutex;
    std::list<const InWork*> in_work;

    /// Keeps one among them.
    class Entry {
    public:
        Entry(Implementation& server, const InWork& work) : server_(server) {
            const std::lock_guard lock(server_.mutex);
            at_ = server_.in_work.insert(server_.in_work.end(), &work);
        }
        ~Entry() {
            const std::lock_guard lock(server_.mutex);
            server_.in_work.erase(at_);
        }
        Entry(const Entry&) = delete;
        Entry& operator=(const Entry&) = delete;

    private:
        Implementation& server_;
        std::list<const InWork*>::iterator at_;
    };

    static InWork& current() {
        thread_local InWork work;
        return work;
    }

    /// To the exchange that this thread has.
    void respond(const httplib::Request& in, httplib::Response& out) {
        InWork& work = current();
        work.keeps = work.exchange.head.keep_alive && !work.exchange.refused;
        Response response = response_to(work);
        const std::size_t size = std::max(response.body.size(), response.gzipped_from);
        if (size + response.held > small_answer && connections->memory().is_full())
            response = memory_refusal();
        for (auto& header : sharing_headers(work.exchange.head, options.access))
            response.headers.push_back(std::move(header));
        work.connection->hold(response.body.size() + response.held);
        // Of a stream that comes in no chunks the end is that of its connection.
        if (response.stream && !work.exchange.head.takes_chunks) work.keeps = false;
        work.timing = response.timing;
        if (response.problem) work.lacking = response.problem->lacking;
        send(work.exchange.head, work.id, out, std::move(response));
        work.status = out.status;
        // A client must hear that its connection ends, and the library says so to who asks for it.
        if (closing) work.keeps = false;
        if (!work.keeps) const_cast<httplib::Request&>(in).set_header("Connection", "close");
    }

    Response response_to(InWork& work) const {
        Exchange& exchange = work.exchange;
        if (exchange.refused) return std::move(*exchange.refused);
        const std::size_t size = exchange.body.size();
        Response response = answer_of_route(work);
        if (size >= large_body) give_memory_back();
        return response;
    }

    Response answer_of_route(InWork& work) const {
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
                 .known_tags = std::string(head.header("if-none-match")),
                 .id = work.id,
                 .left = [&work] { return work.stream->has_left(); }});
        } catch (...) {
            log_failure(std::string(head.path()), work.id, std::current_exception());
            return problem_response(500, "the server failed at this request; its log says why");
        }
    }

    /// What is known of it before its answer.
    static Served served_so_far(const InWork& work) {
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

    /// False where the answer was broken off.
    bool write_among_others(const InWork& work) {
        const Entry entry(*this, work);
        return write(*work.stream) && work.stream->finish();
    }
    bool write(SocketStream& stream) {
        try {
            return http.answer(stream);
        } catch (...) {  // by an answer that is made while it is sent
            log_failure(
                std::string(current().exchange.head.path()), current().id,
                std::current_exception());
            return false;
        }
    }

    /// True: another request may follow on the connection.
    bool answer(Connection& connection, Exchange exchange, Patience patience) {
        // All that the library is told of the request: its answer to a HEAD has no body.
        const char* method = exchange.head.method == "HEAD" ? "HEAD" : "GET";
        SocketStream stream(
            connection, fmt::format("{} / HTTP/1.1\r\n\r\n", method), std::move(patience));
        InWork& work = current();
        std::string id = request_id(exchange.head);
        work = {&connection, std::move(exchange), &stream, std::move(id)};
        const bool sent = write_among_others(work);
        const bool keeps = sent && work.keeps;
        if (!sent) connection.break_off();
        Served served = served_so_far(work);
        served.lacking = work.lacking;
        served.status = work.status;
        served.timing = work.timing;
        served.bytes = stream.written();
        served.left = !sent;
        log_served(served);
        metrics.count_served(served);
        work = {};
        return keeps;
    }

    Admitted admit(const Head& head) const {
        Admitted admitted{.route = find_route(routes, head.method, head.path())};
        admitted.refused = access_refusal(head, admitted.route, options.access);
        if (!admitted.refused && is_preflight(head, options.access)) admitted.route = &preflight;
        if (!admitted.refused)
            admitted.refused = refusal(head, admitted.route, routes, options.payload_limit);
        return admitted;
    }

    Answering answering() {
        return {
            .admission = [this](const Head& head) { return admit(head); },
            .answer =
                [this](Connection& connection, Exchange exchange, Patience patience) {
                    return answer(connection, std::move(exchange), std::move(patience));
                },
            .overloaded =
                [] {
                    return problem_response(api::Problem::unavailable(
                        "threads", "as many requests as the server takes are in work already"));
                }};
    }
};

Server::Server(const ServerOptions& options, std::vector<Route> routes, Metrics& metrics)
    : implementation_(std::make_unique<Implementation>(options, std::move(routes), metrics)) {
    Engine& http = implementation_->http;
    http.set_keep_alive_timeout(idle_time.count());  // as it tells its clients
    http.set_keep_alive_max_count(1000000);
    http.set_pre_routing_handler([this](const auto& in, auto& out) {
        implementation_->respond(in, out);
        return Handled::Handled;
    });
    // It would say that the body has no bytes, which is not that of the answer which is known.
    http.set_post_routing_handler([](const auto&, auto& out) {
        if (out.status == 304) out.headers.erase("Content-Length");
    });
    // Not the library's SO_REUSEPORT: with that a second server on the same port starts without
    // a word and takes half of the requests.
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
    implementation_->connections.emplace(
        http.listening(),
        ConnectionLimits{
            .connections = options.connections,
            .workers = options.threads,
            .waiting = static_cast<std::size_t>(options.threads),
            .held_bytes = options.memory_limit},
        implementation_->answering());
    implementation_->metrics.watch([this] { return implementation_->connections->load(); });
    return port;
}

void Server::run() { implementation_->connections->run(); }

void Server::close_connections() { implementation_->closing = true; }

void Server::stop() {
    close_connections();
    implementation_->connections->stop();
}

std::size_t Server::log_cut_off() {
    const std::size_t number = implementation_->connections->load().in_flight;
    const std::lock_guard lock(implementation_->mutex);
    for (const auto* work : implementation_->in_work)
        http::log_cut_off(Implementation::served_so_far(*work));
    return number;
}

}  // namespace vines::http
