#include "http/server.hpp"

#include <sys/socket.h>

#include <cstring>

#include "http/encoding.hpp"

#include <httplib.h>  // after Eigen's headers, which one of its macros breaks

namespace vines::http {

namespace {

// httplib's default of 5 would refuse some of 400 simultaneous clients.
constexpr int backlog = 4096;

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

/// A bound socket. A port of 0 becomes the one that was free.
Descriptor listen_on(const std::string& host, int& port) {
    struct Listener : httplib::Server {
        int socket() const { return svr_sock_; }
    } listener;
    // Replaces httplib's SO_REUSEPORT: with it a second server on the same port would start without
    // an error and take half of the requests.
    listener.set_socket_options([](auto socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    errno = 0;
    const int bound = port == 0                           ? listener.bind_to_any_port(host)
                      : listener.bind_to_port(host, port) ? port
                                                          : 0;
    if (bound <= 0) throw std::runtime_error(why_not_bound(host, port, errno));
    port = bound;
    ::listen(listener.socket(), backlog);
    return Descriptor(listener.socket());
}

}  // namespace

Server::Server(ServerOptions options, std::vector<Route> routes, Metrics& metrics)
    : options_(std::move(options)),
      routes_(std::move(routes)),
      metrics_(metrics),
      port_(options_.port),
      event_loop_(
          listen_on(options_.access.host, port_), options_.limits, options_.access.proxies, *this) {
    metrics_.watch_connections([this] { return event_loop_.load(); });
}

void Server::stop() {
    close_connections();
    event_loop_.stop();
}

std::size_t Server::log_unanswered() {
    const std::size_t number = event_loop_.load().in_flight;
    const std::lock_guard lock(mutex_);
    for (const auto& delivery : deliveries_)
        http::log_unanswered(
            delivery->request, in_ms(Stopwatch::Clock::now() - delivery->request.since));
    return number;
}

void Server::check_head(Request& request, const std::string& peer) const {
    http::check_head(request, peer, routes_, options_.access);
}

Task Server::answer(Connection& connection, Request received) {
    const auto delivery = std::make_shared<Delivery>(std::move(received), connection.socket());
    Request& request = delivery->request;
    request.id = request_id(request.head);
    request.left = [&outbox = delivery->outbox] { return outbox.client_has_left(); };
    request.awaits_memory = [this, &request](MemoryBudget::Bytes bytes, auto since) {
        return event_loop_.memory().must_wait(request.sender.client(), bytes, since);
    };
    request.reserve_memory = [&](MemoryBudget::Bytes bytes, auto since) {
        return connection.reserve(request.sender.client(), bytes, since);
    };
    request.others_need_threads = [this, &request](bool even_last) {
        return event_loop_.others_need_threads(request.sender.client(), even_last);
    };
    {
        const std::lock_guard lock(mutex_);
        deliveries_.insert(delivery);
    }
    Response response;
    try {
        response = completed(request, answer_to(request));
    } catch (...) {
        std::string().swap(request.body);
        log_failure(request.head.path(), request.id);
        response = completed(
            request, problem_response(500, "the server failed; the reason is in its log"));
    }
    Outcome& outcome = delivery->outcome;
    outcome.status = response.status;
    outcome.timing = response.timing;
    if (response.problem) outcome.lacking = response.problem->lacking;
    if (outcome.lacking == "sweeps") event_loop_.note_scarcity_of_streams();
    connection.hold(request.sender.client(), {response.body.size() + response.held, response.held});
    // Numbers are compressed to a fourth or so.
    const std::size_t length = response.length / (response.compressible ? 4 : 1);
    delivery->outbox.expect(std::max(response.held, length));
    delivery->is_streaming = static_cast<bool>(response.stream);
    // Without chunks only the end of the connection marks the end of a stream.
    delivery->keep_alive = request.head.keep_alive && !request.refused && !closing_ &&
                           (request.head.takes_chunks || !response.stream);
    connection.begin_delivery(delivery);
    const auto send = [delivery](Response answer) {
        const Head& head = delivery->request.head;
        bool whole = false;
        try {
            whole = write(head, delivery->keep_alive, std::move(answer), delivery->outbox);
        } catch (...) {  // thrown by an answer that is made while it is sent
            log_failure(head.path(), delivery->request.id);
        }
        delivery->outbox.end(whole);
    };
    if (response.stream) return [send, response] { send(response); };
    send(std::move(response));
    return {};
}

/// The response of the route, or the refusal. Frees the request's body.
Response Server::answer_to(Request& request) const {
    if (request.refused) return std::move(*request.refused);
    const std::size_t size = request.body.size();
    Response response = request.route->answer(request);
    std::string().swap(request.body);
    if (size >= large_body) trim_memory();
    return response;
}

Response Server::completed(const Request& request, Response response) {
    const auto size = std::max(response.body.size(), response.uncompressed_size) + response.held;
    if (size > small_answer &&
        !request.reserve_memory({size, response.held}, Stopwatch::Clock::now()))
        response = memory_refusal();
    std::ranges::move(
        cors_headers(request.head, options_.access), std::back_inserter(response.headers));
    complete(request, response);
    return response;
}

/// Logs and counts a request at the end of its answer.
void Server::finish(const std::shared_ptr<Delivery>& delivery, Outbox::State state) {
    const Request& request = delivery->request;
    Outcome& outcome = delivery->outcome;
    outcome.route = request.route ? request.route->name : "none";
    outcome.ms = in_ms(Stopwatch::Clock::now() - request.since);
    outcome.bytes = delivery->outbox.sent();
    outcome.left = state == Outbox::State::broken;
    log_request(request, outcome);
    metrics_.count_answer(request.head.method, outcome);
    const std::lock_guard lock(mutex_);
    deliveries_.erase(delivery);
}

}  // namespace vines::http
