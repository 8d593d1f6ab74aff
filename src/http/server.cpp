#include "http/server.hpp"

#include <httplib.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>
#include <zlib.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <thread>

#include "http/routes.hpp"

namespace vines::http {

namespace {

using Clock = std::chrono::steady_clock;

// Below this the time to compress costs more than the bytes.
constexpr std::size_t compress_from = 64 * 1024;
constexpr int backlog = 512;  // httplib's own is 5: of 400 clients at once some would be refused

/// gzip, level 1: a third of the size in a tenth of level 6's time, for columns of numbers.
std::string gzip(const std::string& text) {
    z_stream stream{};
    if (deflateInit2(&stream, 1, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw std::runtime_error("zlib: deflateInit2");
    std::string out;
    // The whole may be 4 GiB and more, of which zlib cannot count.
    std::vector<char> piece(1 << 20);
    int result = Z_OK;
    for (std::size_t at = 0; result == Z_OK; at += piece.size()) {
        const std::size_t size = std::min(piece.size(), text.size() - at);
        stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data() + at));
        stream.avail_in = static_cast<uInt>(size);
        const int flush = at + size == text.size() ? Z_FINISH : Z_NO_FLUSH;
        do {
            stream.next_out = reinterpret_cast<Bytef*>(piece.data());
            stream.avail_out = static_cast<uInt>(piece.size());
            result = deflate(&stream, flush);
            if (result == Z_BUF_ERROR) result = Z_OK;  // nothing was left to do
            out.append(piece.data(), piece.size() - stream.avail_out);
        } while (result == Z_OK && stream.avail_out == 0);
    }
    deflateEnd(&stream);
    if (result != Z_STREAM_END) throw std::runtime_error("zlib: deflate");
    return out;
}

/// FNV-1a, 64 bits: tells versions of a body apart, guards against nothing.
std::string entity_tag(const std::string& body) {
    std::uint64_t hash = 0xcbf29ce484222325;
    for (unsigned char c : body) hash = (hash ^ c) * 0x100000001b3;
    char text[24];
    std::snprintf(text, sizeof text, "W/\"%016llx\"", static_cast<unsigned long long>(hash));
    return text;
}

bool accepts_gzip(const httplib::Request& request) {
    const std::string accepted = request.get_header_value("Accept-Encoding");
    const std::size_t at = accepted.find("gzip");
    return at != std::string::npos && accepted.compare(at + 4, 4, ";q=0") != 0;
}

/// Sends through a content provider, which keeps the library from compressing (brotli at its
/// slowest, 2 s for 1.7 MB). With `close` the connection ends after the answer: a body that nobody
/// read must not be taken for the next request.
void send(
    const httplib::Request& request, httplib::Response& out, Response response,
    bool close = false) {
    if (request.method == "GET" && response.status == 200) {
        const std::string tag = entity_tag(response.body);
        out.set_header("ETag", tag);
        out.set_header("Cache-Control", "no-cache");  // ask again, with the tag
        if (request.get_header_value("If-None-Match").find(tag) != std::string::npos) {
            out.status = 304;
            return;
        }
    }
    if (response.body.size() >= compress_from) {
        out.set_header("Vary", "Accept-Encoding");
        if (accepts_gzip(request)) {
            response.body = gzip(response.body);
            out.set_header("Content-Encoding", "gzip");
        }
    }
    out.status = response.status;
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
    if (close) out.set_header("Connection", "close");
    auto body = std::make_shared<const std::string>(std::move(response.body));
    out.set_content_provider(
        body->size(), response.content_type,
        [body, close](std::size_t offset, std::size_t, httplib::DataSink& sink) {
            const bool sent = sink.write(body->data() + offset, body->size() - offset);
            return sent && !close;
        });
}

class SinkWriter : public Writer {
public:
    explicit SinkWriter(httplib::DataSink& sink) : sink_(sink) {}
    bool write(const std::string& text) override { return sink_.write(text.data(), text.size()); }
    bool present() override { return sink_.is_writable(); }

private:
    httplib::DataSink& sink_;
};

void send_stream(httplib::Response& out, Response response) {
    out.status = response.status;
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
    out.set_chunked_content_provider(
        response.content_type,
        [stream = std::move(response.stream)](std::size_t, httplib::DataSink& sink) {
            SinkWriter writer(sink);
            stream(writer);
            sink.done();
            return true;
        });
}

/// A percent-encoded part of a query.
std::string decoded(std::string_view text) {
    std::string out;
    auto digit = [&](std::size_t i) {
        return i < text.size() && std::isxdigit(static_cast<unsigned char>(text[i]));
    };
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && digit(i + 1) && digit(i + 2)) {
            out += static_cast<char>(std::stoi(std::string(text.substr(i + 1, 2)), nullptr, 16));
            i += 2;
        } else {
            out += text[i] == '+' ? ' ' : text[i];
        }
    }
    return out;
}

/// The pairs of a query, each split at its first "="; the library splits at the last and would read
/// b=1=2 as b = 2.
std::vector<std::pair<std::string, std::string>> query_of(std::string_view target) {
    std::vector<std::pair<std::string, std::string>> pairs;
    const std::size_t mark = target.find('?');
    if (mark == std::string_view::npos) return pairs;
    std::string_view rest = target.substr(mark + 1);
    rest = rest.substr(0, rest.find('#'));
    while (!rest.empty()) {
        const std::string_view part = rest.substr(0, rest.find('&'));
        rest.remove_prefix(std::min(rest.size(), part.size() + 1));
        if (part.empty()) continue;
        const std::size_t equals = std::min(part.find('='), part.size());
        pairs.emplace_back(
            decoded(part.substr(0, equals)),
            decoded(part.substr(std::min(part.size(), equals + 1))));
    }
    return pairs;
}

/// httplib keeps its listening socket to itself and its subclasses.
class ListeningServer : public httplib::Server {
public:
    void widen_backlog() { ::listen(svr_sock_, backlog); }
};

}  // namespace

struct Server::Implementation {
    ServerOptions options;
    std::vector<Route> routes;
    ListeningServer http;
    std::atomic<int> in_work = 0;

    // Of the request that this I/O thread works on.
    struct InWork {
        bool counted = false;
        Clock::time_point since;
    };
    static InWork& current() {
        thread_local InWork work;
        return work;
    }

    const Route* find(const std::string& method, const std::string& path) const {
        for (const Route& r : routes)
            if (r.path == path && (r.method == method || (r.method == "GET" && method == "HEAD")))
                return &r;
        return nullptr;
    }

    std::string methods_of(const std::string& path) const {
        std::string list;
        for (const Route& r : routes)
            if (r.path == path)
                list += (list.empty() ? "" : ", ") + r.method + (r.method == "GET" ? ", HEAD" : "");
        return list;
    }

    static Request to_request(const httplib::Request& in, std::string body) {
        return {
            in.method, in.path, query_of(in.target), in.get_header_value("Content-Type"),
            std::move(body)};
    }

    std::size_t limit_of(const httplib::Request& in) const {
        const Route* route = find(in.method, in.path);
        return std::max(options.payload_limit, route ? route->body_limit : 0);
    }
    Response too_large(const httplib::Request& in) const {
        return problem_response(
            413, "the body is larger than " + std::to_string(limit_of(in)) + " bytes");
    }

    /// What must be refused before its body is read, or an empty status.
    Response refusal(const httplib::Request& in) const {
        const std::string type = in.get_header_value("Content-Type");
        if (methods_of(in.path).empty())
            return problem_response(404, "there is nothing at " + in.path);
        if (!find(in.method, in.path)) {
            Response r = problem_response(
                405, in.path + " takes " + methods_of(in.path) + ", not " + in.method);
            r.headers.emplace_back("Allow", methods_of(in.path));
            return r;
        }
        if (in.has_header("Transfer-Encoding"))
            return problem_response(411, "send the body with a Content-Length, not in chunks");
        if (in.has_header("Content-Encoding"))
            return problem_response(415, "send the body uncompressed");
        if (type.rfind("multipart/", 0) == 0)
            return problem_response(
                415, "send the JSON object as the body itself, not as multipart/form-data");
        const std::string length = in.get_header_value("Content-Length");
        if (in.get_header_value_count("Content-Length") > 1 ||
            length.find_first_not_of("0123456789") != std::string::npos)
            return problem_response(400, "the Content-Length must be one whole number");
        if (in.method == "POST" && !in.has_header("Content-Length"))
            return problem_response(411, "send a body with its Content-Length");
        // One that is moderately too large is read and dropped first (post): closing on it at once
        // would reset the connection, and some clients would never see the answer.
        if (std::strtoull(length.c_str(), nullptr, 10) > 64 * limit_of(in)) return too_large(in);
        return Response{0, "", ""};
    }

    httplib::Server::HandlerResponse before_routing(
        const httplib::Request& in, httplib::Response& out) {
        current() = {true, Clock::now()};
        ++in_work;
        using Handled = httplib::Server::HandlerResponse;
        // 200 overlapping ranges of one answer would be 200 answers; the library cuts this one up,
        // too.
        if (!in.ranges.empty()) {
            const_cast<httplib::Request&>(in).ranges.clear();
            send(
                in, out,
                problem_response(
                    416,
                    "this service does not send parts of an answer; leave out the Range header"),
                true);
            return Handled::Handled;
        }
        Response refused = refusal(in);
        if (refused.status != 0) {
            const bool body_unread =
                in.has_header("Content-Length") || in.has_header("Transfer-Encoding");
            send(in, out, std::move(refused), body_unread);
            return Handled::Handled;
        }
        if (in.method == "POST") return Handled::Unhandled;  // the body comes next
        send(in, out, find(in.method, in.path)->answer(to_request(in, "")));
        return Handled::Handled;
    }

    /// Reads the body as it is: read by the library, one of the type that curl -d sends would be
    /// parsed as a form and be refused above 8 kB.
    void post(
        const httplib::Request& in, httplib::Response& out, const httplib::ContentReader& read) {
        std::string body;
        const std::size_t limit = limit_of(in);
        bool too_long = false;
        const bool complete = read([&](const char* data, std::size_t size) {
            // What is too large is read to its end, so that the client gets to read the answer.
            too_long = too_long || body.size() + size > limit;
            if (!too_long) body.append(data, size);
            return true;
        });
        if (out.status == 413 || too_long) return send(in, out, too_large(in), true);
        if (!complete)
            return send(
                in, out, problem_response(400, "the body ended before its Content-Length"), true);
        Response response = find("POST", in.path)->answer(to_request(in, std::move(body)));
        if (response.stream) return send_stream(out, std::move(response));
        send(in, out, std::move(response));
    }

    /// Answers that the library makes itself (a malformed request line, headers too long) have no
    /// body of ours yet.
    static void explain(const httplib::Request& in, httplib::Response& out) {
        if (out.has_header("Content-Type")) return;
        send(in, out, problem_response(out.status, "the request could not be read"));
    }

    void log(const httplib::Request& in, const httplib::Response& out) {
        InWork& work = current();
        const double ms =
            work.counted
                ? std::chrono::duration<double, std::milli>(Clock::now() - work.since).count()
                : 0;
        const nlohmann::ordered_json line = {
            {"time", now()},
            {"level", "info"},
            {"method", in.method},
            {"path", in.path},
            {"status", out.status},
            {"ms", std::round(ms * 1000) / 1000},
            {"bytes", out.content_length_}};
        spdlog::info(line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
        if (work.counted) --in_work;
        work.counted = false;
    }

    static std::string now() {
        const std::time_t seconds = std::time(nullptr);
        std::tm parts;
        gmtime_r(&seconds, &parts);
        char text[24];
        std::strftime(text, sizeof text, "%FT%TZ", &parts);
        return text;
    }
};

Server::Server(const ServerOptions& options, std::vector<Route> routes)
    : implementation_(std::make_unique<Implementation>()) {
    Implementation& self = *implementation_;
    self.options = options;
    self.routes = std::move(routes);
    httplib::Server& http = self.http;
    http.new_task_queue = [threads = options.threads] { return new httplib::ThreadPool(threads); };
    // Not the library's SO_REUSEPORT: with that a second server on the same port starts without a
    // word and takes half of the requests.
    http.set_socket_options([](auto socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    http.set_tcp_nodelay(true);
    http.set_keep_alive_max_count(1000);
    http.set_keep_alive_timeout(5);
    http.set_read_timeout(10);
    http.set_write_timeout(30);
    std::size_t largest = options.payload_limit;
    for (const Route& route : self.routes) largest = std::max(largest, route.body_limit);
    http.set_payload_max_length(largest);
    http.set_pre_routing_handler(
        [&self](const auto& in, auto& out) { return self.before_routing(in, out); });
    for (const Route& route : self.routes)
        if (route.method == "POST") {
            std::string pattern;  // the library takes a regular expression
            for (char c : route.path)
                pattern +=
                    std::strchr(".+*?^$()[]{}|\\", c) ? std::string("\\") + c : std::string(1, c);
            http.Post(pattern, [&self](const auto& in, auto& out, const auto& read) {
                self.post(in, out, read);
            });
        }
    http.set_exception_handler([](const auto& in, auto& out, std::exception_ptr thrown) {
        try {
            std::rethrow_exception(thrown);
        } catch (const std::exception& e) {
            spdlog::error(
                nlohmann::ordered_json{{"level", "error"}, {"path", in.path}, {"what", e.what()}}
                    .dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
        } catch (...) {}
        send(
            in, out, problem_response(500, "the server failed at this request; its log says why"),
            true);
    });
    http.set_error_handler(httplib::Server::HandlerWithResponse([](const auto& in, auto& out) {
        Implementation::explain(in, out);
        return httplib::Server::HandlerResponse::Handled;
    }));
    http.set_logger([&self](const auto& in, const auto& out) { self.log(in, out); });
}

Server::~Server() = default;

int Server::bind() {
    Implementation& self = *implementation_;
    errno = 0;
    int port = self.options.port;
    const bool bound = port == 0 ? (port = self.http.bind_to_any_port(self.options.host)) > 0
                                 : self.http.bind_to_port(self.options.host, port);
    if (!bound)
        throw std::runtime_error(
            "cannot listen on " + self.options.host + ":" + std::to_string(self.options.port) +
            (errno ? std::string(": ") + std::strerror(errno) : ""));
    self.http.widen_backlog();
    return port;
}

void Server::run() { implementation_->http.listen_after_bind(); }

void Server::stop() {
    // The library cuts answers off in the middle when it stops, so let those in work finish first.
    const auto latest = Clock::now() + std::chrono::seconds(10);
    while (implementation_->in_work > 0 && Clock::now() < latest)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    implementation_->http.stop();
}

int get_status(const std::string& host, int port, const std::string& path) {
    httplib::Client client(host, port);
    client.set_connection_timeout(2);
    client.set_read_timeout(2);
    const auto result = client.Get(path);
    return result ? result->status : 0;
}

}  // namespace vines::http
