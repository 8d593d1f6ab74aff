// Response times of running services over a keep-alive connection, next to a bare server of the
// same HTTP library with the same bytes ready, as rows of scripts/bench's table: bench_answers
// PORT... All are measured in turn.
#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "table.hpp"

using namespace vines::bench;

namespace {

/// A connection that sends a request and waits for the response.
class Connection {
public:
    explicit Connection(int port)
        : socket_(::socket(AF_INET, SOCK_STREAM, 0)),
          text_(1 << 21, ' ') {
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(port));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0)
            throw std::runtime_error("no server at port " + std::to_string(port));
    }
    ~Connection() { ::close(socket_); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Body of the response, valid until the next call.
    std::string_view ask(const std::string& request) {
        if (::send(socket_, request.data(), request.size(), 0) < 0)
            throw std::runtime_error("the connection is closed");
        std::size_t have = 0, head = 0, whole = std::string::npos;
        while (have < whole) {
            const ssize_t n = ::recv(socket_, text_.data() + have, text_.size() - have, 0);
            if (n <= 0) throw std::runtime_error("the connection is closed");
            have += static_cast<std::size_t>(n);
            if (whole != std::string::npos) continue;
            const std::string_view text(text_.data(), have);
            if ((head = text.find("\r\n\r\n")) == std::string_view::npos) continue;
            head += 4;
            constexpr std::string_view length = "Content-Length: ";
            whole =
                head + std::strtoul(text.data() + text.find(length) + length.size(), nullptr, 10);
        }
        return std::string_view(text_).substr(head, whole - head);
    }

private:
    const int socket_;
    std::string text_;
};

/// Answers every POST and GET with the same body.
class BareServer {
public:
    explicit BareServer(std::string body) : body_(std::move(body)) {
        const auto answer = [this](const httplib::Request&, httplib::Response& out) {
            out.set_content(body_, "application/json");
        };
        server_.new_task_queue = [] { return new httplib::ThreadPool(8); };
        server_.set_tcp_nodelay(true);
        server_.set_keep_alive_max_count(1000);
        server_.Post("/v1/simulate", answer);
        server_.Get("/v1/simulate", answer);
        port = server_.bind_to_any_port("127.0.0.1");
        thread_ = std::thread([this] { server_.listen_after_bind(); });
    }
    ~BareServer() {
        server_.stop();
        thread_.join();
    }

    int port;

private:
    const std::string body_;
    httplib::Server server_;
    std::thread thread_;
};

std::string post(const std::string& body, const char* headers = "") {
    return std::string("POST /v1/simulate HTTP/1.1\r\nHost: localhost\r\n") + headers +
           "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
}
std::string get(const std::string& query) {
    return "GET /v1/simulate?" + query + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
}

/// Microseconds from a request to the end of its response; one round of `count` sequential
/// requests.
double microseconds(int port, const std::string& request, int count) {
    Connection connection(port);
    connection.ask(request);
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < count; ++k) connection.ask(request);
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - start;
    return taken.count() / count;
}

void bench_answer(
    const std::string& name, const std::string& request, int count,
    const std::vector<int>& services) {
    std::string body = std::string(Connection(services[0]).ask(request));
    const std::size_t size = body.size();
    const BareServer bare(std::move(body));
    std::vector<int> ports = services;
    ports.push_back(bare.port);
    std::vector<std::function<double()>> measurements;
    for (int port : ports)
        measurements.push_back(
            [&request, port, count] { return microseconds(port, request, count); });
    const auto times = in_turn(9, measurements);
    const std::string what = "over HTTP: " + name + ", " + std::to_string(size) + " bytes";
    for (std::size_t i = 0; i < services.size(); ++i) {
        const std::string who =
            what + (services.size() > 1 ? ", at port " + std::to_string(services[i]) : "");
        row(who, times[i], "us",
            ", at " + digits(100 * median(ratios(times.back(), times[i]))) +
                " % of the rate of a bare server");
    }
}

/// Without the bare server, which would compress the compressed bytes again.
void bench_gzipped(int port) {
    const std::string request = post("{}", "Accept-Encoding: gzip\r\n");
    const std::size_t size = Connection(port).ask(request).size();
    const auto times = in_turn(9, {[&] { return microseconds(port, request, 10); }});
    row("over HTTP: the default request, gzipped, " + std::to_string(size) + " bytes", times[0],
        "us");
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<int> services;
    for (int i = 1; i < argc; ++i) services.push_back(std::atoi(argv[i]));
    if (services.empty()) {
        std::fprintf(stderr, "bench_answers PORT...\n");
        return 2;
    }
    bench_answer(
        "impacts to tau = 200", post(R"({"tau_end":200,"include":["impacts"]})"), 500, services);
    bench_answer(
        "a run to tau = 20, `include` empty", post(R"({"tau_end":20,"include":[]})"), 500,
        services);
    bench_answer(
        "the README's first request", get("preset=fig11&include=regime,energy"), 30, services);
    bench_answer(
        "10,000 samples to tau = 1709",
        post(R"({"tau_end":1709,"samples_per_cycle":36.764,"include":["series"]})"), 30, services);
    bench_answer("the default request", post("{}"), 30, services);
    bench_gzipped(services[0]);
}
