// The HTTP server. A request passes these phases:
// 1. The event loop reads its head (head.hpp). Its route and access control (access.hpp) accept or
//    refuse it before its body is read (connection.hpp).
// 2. A worker takes the complete request and calls the route's function. Routes that compute wait
//    for admission (admission_control.hpp).
// 3. The worker sends what the client's socket takes of the answer (encoding.hpp, outbox.hpp); the
//    event loop sends the rest. At its end the answer is logged and counted.
#pragma once

#include <set>

#include "http/access.hpp"
#include "http/event_loop.hpp"

namespace vines::http {

struct ServerOptions {
    int port = 8080;  ///< 0: any free port
    ConnectionLimits limits = {};
    AccessOptions access = {};
};

class Server : private RequestHandler {
public:
    /// Binds; throws std::runtime_error with the reason if that fails. The metrics must outlive the
    /// server.
    Server(ServerOptions options, std::vector<Route> routes, Metrics& metrics);

    int port() const { return port_; }
    /// Serves until stop() is called and the requests then in progress are answered.
    void run() { event_loop_.run(); }
    /// From now on each answer is the last one on its connection. From any thread.
    void close_connections() { closing_ = true; }
    /// Accepts no new requests, and lets run() return once all are answered. From any thread, once.
    void stop();
    /// Logs the requests that are not yet answered, before the process ends without answering them;
    /// returns their number. From any thread.
    std::size_t log_unanswered();

private:
    void check_head(Request& request, const std::string& peer) const override;
    Task answer(Connection& connection, Request received) override;
    void finish(const std::shared_ptr<Delivery>& delivery, Outbox::State state) override;
    Response answer_to(Request& request) const;
    Response completed(const Request& request, Response response);

    const ServerOptions options_;
    const std::vector<Route> routes_;
    Metrics& metrics_;
    int port_;
    std::atomic<bool> closing_ = false;
    /// Those that the end of the process would leave unfinished. Other threads than the one that
    /// answers read only what stays constant while the delivery is in the set.
    std::mutex mutex_;
    std::set<std::shared_ptr<const Delivery>> deliveries_;
    EventLoop event_loop_;  // destroyed first: it still answers
};

}  // namespace vines::http
