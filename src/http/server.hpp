// The HTTP server: bytes to requests and back.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "http/access.hpp"
#include "http/metrics.hpp"
#include "http/route.hpp"

namespace vines::http {

struct ServerOptions {
    std::string host = "127.0.0.1";
    int port = 8080;                       ///< 0: any free one
    int threads = 128;                     ///< that answer: a client that reads slowly holds one
    std::size_t connections = 4096;        ///< open at once, idle ones too
    std::size_t payload_limit = 1 << 20;   ///< bytes of a request's body
    std::size_t memory_limit = 512 << 20;  ///< bytes of requests and answers held at once
    AccessOptions access = {};             ///< its address is `host`
};

class Server {
public:
    /// The metrics outlive it.
    Server(const ServerOptions& options, std::vector<Route> routes, Metrics& metrics);
    ~Server();

    /// Binds and returns the port. Throws std::runtime_error with the reason where that fails.
    int bind();
    /// Serves until stop() is called and what is in work then is answered. Call bind() first.
    void run();
    /// From now on each answer is the last one of its connection. From any thread.
    void close_connections();
    /// Takes nothing new, and makes run() return once all is answered. From any thread, once.
    void stop();
    /// Says in the log which requests are not answered yet, for who ends the process without that;
    /// returns how many. From any thread.
    std::size_t log_cut_off();

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace vines::http
