#include "http/server.hpp"

#include <fmt/format.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "http/encoding.hpp"
#include "http/head.hpp"
#include "http/log.hpp"
#include "http/memory.hpp"

#include <httplib.h>  // after Eigen's headers, which one of its macros breaks

namespace vines::http {

namespace {

// httplib's default of 5 would refuse some of 400 simultaneous clients.
constexpr int backlog = 512;

// Largest answer sent even when the memory budget is used up, bytes: the number of connections
// bounds these.
constexpr std::size_t small_answer = 1 << 16;

// From this size on the memory of a body, several times its size, is returned to the system at
// once. That takes as long as to read a part of it. Bytes.
constexpr std::size_t large_body = 1 << 20;

/// Reason and remedy. error: errno, or 0 if unknown.
std::string why_not_bound(const std::string& host, int port, int error) {
    constexpr const char* other_port = "use --port, or --port 0 for any free one";
    if (error == EADDRINUSE) return fmt::format("port {} is taken; {}", port, other_port);
    if (error == EACCES) return fmt::format("port {} needs privileges; {}", port, other_port);
    if (error == 0 || error == EADDRNOTAVAIL)
        return fmt::format("cannot listen on {}; use --host with an address of this machine", host);
    return fmt::format("cannot listen on {}:{}: {}", in_url(host), port, std::strerror(error));
}

double ms_since(std::chrono::steady_clock::time_point time) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - time)
        .count();
}

}  // namespace

/// httplib's part: it creates the listening socket.
class Server::Listener : public httplib::Server {
public:
    Listener(const std::string& host, int chosen_port) : port(chosen_port) {
        // Replaces httplib's SO_REUSEPORT: with it a second server on the same port would start
        // without an error and take half of the requests.
        set_socket_options([](auto socket) {
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        errno = 0;
        const bool bound =
            port == 0 ? (port = bind_to_any_port(host)) > 0 : bind_to_port(host, port);
        if (!bound) throw std::runtime_error(why_not_bound(host, chosen_port, errno));
        ::listen(svr_sock_, backlog);
    }
    int socket() const { return svr_sock_; }

    int port;
};

/// A request that is being answered.
struct Server::Work {
    Exchange exchange;
    std::shared_ptr<Outbox> outbox;
    Outcome outcome = {};
};

Server::Server(ServerOptions options, std::vector<Route> routes, Metrics& metrics)
    : options_(std::move(options)),
      routes_(std::move(routes)),
      metrics_(metrics),
      listener_(std::make_unique<Listener>(options_.access.host, options_.port)),
      event_loop_(listener_->socket(), options_.limits, options_.access.proxies, *this) {
    metrics_.watch_connections([this] { return event_loop_.load(); });
}

Server::~Server() = default;

int Server::port() const { return listener_->port; }

void Server::stop() {
    close_connections();
    event_loop_.stop();
}

std::size_t Server::log_unanswered() {
    const std::size_t number = event_loop_.load().in_flight;
    const std::lock_guard lock(mutex_);
    for (const auto& work : works_)
        http::log_unanswered(work->exchange.request, ms_since(work->exchange.since));
    return number;
}

void Server::check_head(Exchange& exchange, const std::string& peer) const {
    http::check_head(exchange, peer, routes_, options_.access);
}

Task Server::answer(Connection& connection, Exchange exchange) {
    const auto work = std::make_shared<Work>(
        Work{std::move(exchange), std::make_shared<Outbox>(connection.socket())});
    Request& request = work->exchange.request;
    request.id = request_id(request.head);
    request.left = [outbox = work->outbox] { return outbox->client_has_left(); };
    {
        const std::lock_guard lock(mutex_);
        works_.insert(work);
    }
    Response response;
    try {
        response = completed(request, answer_to(work->exchange));
    } catch (...) {
        std::string().swap(request.body);
        log_failure(request.head.path(), request.id);
        response = completed(
            request, problem_response(500, "the server failed; the reason is in its log"));
    }
    work->outcome.status = response.status;
    work->outcome.timing = response.timing;
    if (response.problem) work->outcome.lacking = response.problem->lacking;
    if (work->outcome.lacking == "sweeps" && !response.own_limit)
        event_loop_.note_scarcity_of_streams();
    connection.hold(response.body.size() + response.held);
    // Without chunks only the end of the connection marks the end of a stream.
    const bool keep_alive = request.head.keep_alive && !work->exchange.refused && !closing_ &&
                            (request.head.takes_chunks || !response.stream);
    connection.begin_delivery(
        {work->outbox, keep_alive, static_cast<bool>(response.stream),
         [this, work](Outbox::State state) { finish(work, state); }});
    const auto send = [work, keep_alive](Response answer) {
        bool whole = false;
        try {
            whole =
                write(work->exchange.request.head, keep_alive, std::move(answer), *work->outbox);
        } catch (...) {  // thrown by an answer that is made while it is sent
            log_failure(work->exchange.request.head.path(), work->exchange.request.id);
        }
        work->outbox->end(whole);
    };
    if (response.stream) return [send, response] { send(response); };
    send(std::move(response));
    return {};
}

/// The response of the route, or the refusal. Frees the request's body.
Response Server::answer_to(Exchange& exchange) const {
    if (exchange.refused) return std::move(*exchange.refused);
    std::string& body = exchange.request.body;
    const std::size_t size = body.size();
    Response response = exchange.route->answer(exchange.request);
    std::string().swap(body);
    if (size >= large_body) trim_memory();
    return response;
}

Response Server::completed(const Request& request, Response response) const {
    const std::size_t size = std::max(response.body.size(), response.uncompressed_size);
    if (size + response.held > small_answer && event_loop_.memory().is_full())
        response = memory_refusal();
    for (auto& header : cors_headers(request.head, options_.access))
        response.headers.push_back(std::move(header));
    complete(request, response);
    return response;
}

/// Logs and counts a request at the end of its answer.
void Server::finish(const std::shared_ptr<Work>& work, Outbox::State state) {
    const Exchange& exchange = work->exchange;
    Outcome& outcome = work->outcome;
    outcome.route = exchange.route ? exchange.route->name : "none";
    outcome.ms = ms_since(exchange.since);
    outcome.bytes = work->outbox->sent();
    outcome.left = state == Outbox::State::broken;
    log_request(exchange.request, outcome);
    metrics_.count_answer(exchange.request.head.method, outcome);
    const std::lock_guard lock(mutex_);
    works_.erase(work);
}

}  // namespace vines::http
