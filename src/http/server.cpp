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
#include <utility>

#include "http/event_loop.hpp"
#include "http/head.hpp"
#include "http/log.hpp"
#include "http/memory.hpp"
#include "http/send.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;

// httplib's default of 5 would refuse some of 400 simultaneous clients.
constexpr int backlog = 512;

// Largest answer sent even when the memory budget is used up, bytes: the number of connections
// bounds these.
constexpr std::size_t small_answer = 1 << 16;

// From this size on the memory of a body, several times its size, is returned to the system at
// once. That takes as long as to read a part of it. Bytes.
constexpr std::size_t large_body = 1 << 20;

/// httplib's part: it creates the listening socket.
class Listener : public httplib::Server {
public:
    Listener() {
        // Replaces httplib's SO_REUSEPORT: with it a second server on the same port would start
        // without an error and take half of the requests.
        set_socket_options([](auto socket) {
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
    }
    int socket() { return svr_sock_; }
    void widen_backlog() { ::listen(svr_sock_, backlog); }
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
    Listener listener;
    std::atomic<bool> closing = false;

    /// A request that is being answered.
    struct Work {
        Exchange exchange;
        std::string id;
        std::shared_ptr<Outbox> outbox;
        ServedRequest served = {};  ///< what is known of the answer
    };
    /// Those that the end of the process would leave unanswered. Other threads than the one that
    /// answers read only members that stay constant while the request is in the list.
    std::mutex mutex;
    std::list<std::shared_ptr<const Work>> works;
    std::optional<EventLoop> event_loop;  // destroyed first: it still answers

    Response completed_response(Work& work) const {
        try {
            return completed(work, response_to(work));
        } catch (...) {
            log_failure(std::string(work.exchange.head.path()), work.id, std::current_exception());
            return completed(
                work, problem_response(500, "the server failed; the reason is in its log"));
        }
    }

    Response completed(const Work& work, Response response) const {
        const Head& head = work.exchange.head;
        const std::size_t size = std::max(response.body.size(), response.uncompressed_size);
        if (size + response.held > small_answer && event_loop->memory().is_full())
            response = memory_refusal();
        for (auto& header : cors_headers(head, options.access))
            response.headers.push_back(std::move(header));
        complete(head, work.id, response);
        return response;
    }

    Response response_to(Work& work) const {
        Exchange& exchange = work.exchange;
        if (exchange.refused) return std::move(*exchange.refused);
        const Head& head = exchange.head;
        const std::size_t size = exchange.body.size();
        Response response = exchange.route->answer(
            {.method = head.method,
             .path = std::string(head.path()),
             .query = api::parse_query(head.query()),
             .content_type = std::string(head.header("content-type")),
             .body = std::move(exchange.body),
             .accept = std::string(head.header("accept")),
             .accept_encoding = std::string(head.header("accept-encoding")),
             .if_none_match = std::string(head.header("if-none-match")),
             .id = work.id,
             .client = exchange.sender.client(),
             .left = [&work] { return work.outbox->client_has_left(); }});
        if (size >= large_body) trim_memory();
        return response;
    }

    /// The log entry of a request, as far as it is known before the answer.
    static ServedRequest begin_log_entry(const Work& work) {
        const Exchange& exchange = work.exchange;
        const std::chrono::duration<double, std::milli> taken = Clock::now() - exchange.since;
        return {
            .id = work.id,
            .client = exchange.sender.address,
            .key = exchange.sender.key,
            .method = exchange.head.method,
            .path = std::string(exchange.head.path()),
            .route = exchange.route ? exchange.route->name : "none",
            .ms = taken.count()};
    }

    /// Answers a request; returns the rest of the work if the answer is computed while it is sent.
    Task answer(Connection& connection, Exchange exchange) {
        std::string id = request_id(exchange.head);
        const auto work = std::make_shared<Work>(Work{
            std::move(exchange), std::move(id), std::make_shared<Outbox>(connection.socket())});
        const auto registered = enter(work);
        Response response = completed_response(*work);
        work->served.timing = response.timing;
        if (response.problem) work->served.lacking = response.problem->lacking;
        if (work->served.lacking == "sweeps" && !response.own_limit)
            event_loop->note_scarcity_of_streams();
        work->served.status = response.status;
        connection.hold(response.body.size() + response.held);
        const Head& head = work->exchange.head;
        // Without chunks only the end of the connection marks the end of a stream.
        const bool keep_alive = head.keep_alive && !work->exchange.refused && !closing &&
                                (head.takes_chunks || !response.stream);
        connection.begin_delivery(
            {work->outbox, keep_alive, static_cast<bool>(response.stream),
             [this, work, registered](Outbox::State state) { finish(*work, registered, state); }});
        const auto send = [work, keep_alive](Response answer) {
            work->outbox->end(write_or_log(*work, keep_alive, std::move(answer)));
        };
        if (response.stream) return [send, response] { send(response); };
        send(std::move(response));
        return {};
    }

    static bool write_or_log(const Work& work, bool keep_alive, Response response) {
        try {
            return write(work.exchange.head, keep_alive, std::move(response), *work.outbox);
        } catch (...) {  // thrown by an answer that is made while it is sent
            log_failure(std::string(work.exchange.head.path()), work.id, std::current_exception());
            return false;
        }
    }

    using Registered = std::list<std::shared_ptr<const Work>>::iterator;
    Registered enter(std::shared_ptr<const Work> work) {
        const std::lock_guard lock(mutex);
        return works.insert(works.end(), std::move(work));
    }

    /// Logs and counts a request at the end of its answer.
    void finish(Work& work, Registered registered, Outbox::State state) {
        ServedRequest served = begin_log_entry(work);
        served.lacking = work.served.lacking;
        served.status = work.served.status;
        served.timing = work.served.timing;
        served.bytes = work.outbox->sent();
        served.left = state == Outbox::State::broken;
        log_request(served);
        metrics.count_served(served);
        const std::lock_guard lock(mutex);
        works.erase(registered);
    }

    CheckedHead check_head(const Head& head, const std::string& peer) const {
        const AccessOptions& access = options.access;
        CheckedHead checked{.route = find_route(routes, head.method, head.path())};
        checked.sender.address = client_address(head, peer, access.proxies);
        if (access.keys) checked.sender.key = access.keys->name_of(head.header("authorization"));
        checked.refused = access_refusal(head, checked.route, checked.sender.key, access);
        if (!checked.refused && is_preflight(head, access)) checked.route = &preflight;
        if (!checked.refused)
            checked.refused = request_refusal(head, checked.route, routes, options.payload_limit);
        return checked;
    }

    Handlers handlers() {
        return {
            .check_head = [this](
                              const Head& head,
                              const std::string& peer) { return check_head(head, peer); },
            .answer = [this](
                          Connection& connection,
                          Exchange exchange) { return answer(connection, std::move(exchange)); }};
    }
};

Server::Server(const ServerOptions& options, std::vector<Route> routes, Metrics& metrics)
    : implementation_(std::make_unique<Implementation>(options, std::move(routes), metrics)) {}

Server::~Server() = default;

int Server::bind() {
    const ServerOptions& options = implementation_->options;
    Listener& listener = implementation_->listener;
    errno = 0;
    int port = options.port;
    const bool bound = port == 0 ? (port = listener.bind_to_any_port(options.host)) > 0
                                 : listener.bind_to_port(options.host, port);
    if (!bound) throw std::runtime_error(why_not_bound(options, errno));
    listener.widen_backlog();
    implementation_->event_loop.emplace(
        listener.socket(),
        ConnectionLimits{
            .connections = options.connections,
            .per_client = options.client_connections,
            .proxies = options.access.proxies,
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
    for (const auto& work : implementation_->works)
        http::log_unanswered(Implementation::begin_log_entry(*work));
    return number;
}

}  // namespace vines::http
