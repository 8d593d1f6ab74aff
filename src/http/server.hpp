// The HTTP server. A request passes these phases:
// 1. The event loop reads its head (head.hpp). Its route and access control
//    (access.hpp) accept or refuse it before its body is read (connection.hpp).
// 2. A worker takes the complete request and calls the route's function. Routes that compute wait
//    for admission (admission_control.hpp).
// 3. The worker sends what the client's socket takes of the answer (send.hpp, outbox.hpp); the
// event
//    loop sends the rest. At its end the answer is logged and counted.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "http/access.hpp"
#include "http/message.hpp"
#include "http/metrics.hpp"

namespace vines::http {

struct ServerOptions {
    std::string host = "127.0.0.1";
    int port = 8080;                 ///< 0: any free port
    int threads = 128;               ///< worker threads; a stream that is read slowly occupies one
    std::size_t connections = 4096;  ///< open connections, including idle ones
    std::size_t client_connections = 1024;  ///< of them those of one client
    std::size_t payload_limit = 1 << 20;    ///< largest request body, bytes
    std::size_t memory_limit = 512 << 20;   ///< requests and answers held at once, bytes
    AccessOptions access = {};              ///< listens_on is set to `host`
};

class Server {
public:
    /// The metrics must outlive the server.
    Server(const ServerOptions& options, std::vector<Route> routes, Metrics& metrics);
    ~Server();

    /// Binds and returns the port. Throws std::runtime_error with the reason if that fails.
    int bind();
    /// Serves until stop() is called and the requests then in progress are answered. Call bind()
    /// first.
    void run();
    /// From now on each answer is the last one on its connection. From any thread.
    void close_connections();
    /// Accepts no new requests, and lets run() return once all are answered. From any thread, once.
    void stop();
    /// Logs the requests that are not yet answered, before the process ends without answering them;
    /// returns their number. From any thread.
    std::size_t log_unanswered();

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace vines::http
