// The HTTP server: bytes to requests and back.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "http/route.hpp"

namespace vines::http {

struct ServerOptions {
    std::string host = "127.0.0.1";
    int port = 8080;                      ///< 0: any free one
    int threads = 64;                     ///< I/O threads: a slow client holds one
    std::size_t payload_limit = 1 << 20;  ///< bytes of a request's body
};

class Server {
public:
    Server(const ServerOptions& options, std::vector<Route> routes);
    ~Server();

    /// Binds and returns the port. Throws std::runtime_error with the reason where that fails.
    int bind();
    /// Serves until stop() is called. Call bind() first.
    void run();
    /// Waits for the answers in work (10 s at most), then makes run() return. From any thread.
    void stop();

private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
};

}  // namespace vines::http
