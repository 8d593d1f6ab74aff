// The HTTP server. A request passes these phases:
// 1. The event loop reads its head (head.hpp). Its route and access control (access.hpp) accept or
//    refuse it before its body is read (connection.hpp).
// 2. A worker takes the complete request and calls the route's function. Routes that compute wait
//    for admission (admission_control.hpp).
// 3. The worker sends what the client's socket takes of the answer (encoding.hpp, outbox.hpp); the
//    event loop sends the rest. At its end the answer is logged and counted.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <set>
#include <vector>

#include "http/access.hpp"
#include "http/event_loop.hpp"
#include "http/message.hpp"
#include "http/metrics.hpp"

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
    ~Server() override;

    int port() const;
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
    class Listener;
    struct Work;

    void check_head(Exchange& exchange, const std::string& peer) const override;
    Task answer(Connection& connection, Exchange exchange) override;
    Response answer_to(Exchange& exchange) const;
    Response completed(const Request& request, Response response) const;
    void finish(const std::shared_ptr<Work>& work, Outbox::State state);

    const ServerOptions options_;
    const std::vector<Route> routes_;
    Metrics& metrics_;
    const std::unique_ptr<Listener> listener_;
    std::atomic<bool> closing_ = false;
    /// Requests that the end of the process would leave unanswered. Other threads than the one that
    /// answers read only what stays constant while the request is in the set.
    std::mutex mutex_;
    std::set<std::shared_ptr<const Work>> works_;
    EventLoop event_loop_;  // destroyed first: it still answers
};

}  // namespace vines::http
