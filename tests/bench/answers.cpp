// How fast running services answer over a connection that is kept, beside a bare server of the same
// library that has the same bytes ready: bench_answers PORT... All are asked in turn, the medians
// count.
#include <arpa/inet.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

/// One connection, that sends a request and waits for the answer.
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

    /// The body of the answer, valid until the next call.
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

double median(std::vector<double> v) {
    std::nth_element(v.begin(), v.begin() + static_cast<long>(v.size() / 2), v.end());
    return v[v.size() / 2];
}

std::string post(const std::string& body) {
    return "POST /v1/simulate HTTP/1.1\r\nHost: localhost\r\nContent-Length: " +
           std::to_string(body.size()) + "\r\n\r\n" + body;
}
std::string get(const std::string& query) {
    return "GET /v1/simulate?" + query + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
}

/// Microseconds from a request to the end of its answer: of a round of so many, one after the
/// other.
double microseconds(int port, const std::string& request, int count) {
    Connection connection(port);
    connection.ask(request);
    const auto start = std::chrono::steady_clock::now();
    for (int k = 0; k < count; ++k) connection.ask(request);
    const std::chrono::duration<double, std::micro> taken =
        std::chrono::steady_clock::now() - start;
    return taken.count() / count;
}

void bench(
    const char* name, const std::string& request, int count, const std::vector<int>& services) {
    std::string body = std::string(Connection(services[0]).ask(request));
    const std::size_t size = body.size();
    const BareServer bare(std::move(body));
    std::vector<int> ports = services;
    ports.push_back(bare.port);
    constexpr int rounds = 9;
    std::vector<std::vector<double>> times(ports.size());
    for (int k = 0; k < rounds; ++k)
        for (std::size_t i = 0; i < ports.size(); ++i)
            times[i].push_back(microseconds(ports[i], request, count));
    const double of_bare = median(times.back());
    std::printf("%-40s %8zu bytes, bare %8.1f us;", name, size, of_bare);
    for (std::size_t i = 0; i < services.size(); ++i) {
        const double of_service = median(times[i]);
        std::printf(
            " service %8.1f us, at %3.0f %% of the bare rate;", of_service,
            100 * of_bare / of_service);
    }
    std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
    std::vector<int> services;
    for (int i = 1; i < argc; ++i) services.push_back(std::atoi(argv[i]));
    if (services.empty()) {
        std::fprintf(stderr, "bench_answers PORT...\n");
        return 2;
    }
    std::printf("one connection, one request after the other; median of 9 rounds\n");
    bench(
        "impacts of tau_end = 200", post(R"({"tau_end":200,"include":["impacts"]})"), 500,
        services);
    bench(
        "a run of tau_end = 20, nothing of it", post(R"({"tau_end":20,"include":[]})"), 500,
        services);
    bench("the README's first request", get("preset=fig11&include=regime,energy"), 30, services);
    bench(
        "10,000 samples of tau_end = 1709",
        post(R"({"tau_end":1709,"samples_per_cycle":36.764,"include":["series"]})"), 30, services);
    bench("the default request", post("{}"), 30, services);
}
