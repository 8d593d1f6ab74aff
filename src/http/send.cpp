#include "http/send.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <httplib.h>

#include <algorithm>
#include <cstring>
#include <ctime>
#include <exception>
#include <functional>
#include <string_view>
#include <utility>

#include "http/connection.hpp"
#include "http/encoding.hpp"

namespace vines::http {

// --- Completing a response ---

namespace {

std::string server_timing(const Timing& timing) {
    std::string text;
    for (const auto& [name, ms] : timing)
        text += fmt::format("{}{};dur={:.3f}", text.empty() ? "" : ", ", name, ms);
    return text;
}

/// Sets ETag and Cache-Control; 304 if the client has the answer. was_304: its tag is known to
/// match.
void set_validators(const Head& head, bool was_304, Response& response) {
    const bool reads = head.method == "GET" || head.method == "HEAD";
    if (!reads || (response.status != 200 && !was_304)) return;
    const std::string tag = response.tag.empty() ? entity_tag(response.body) : response.tag;
    response.headers.emplace_back("ETag", tag);
    // Cached for a year, or revalidated with the tag.
    response.headers.emplace_back(
        "Cache-Control", response.immutable ? "max-age=31536000, immutable" : "no-cache");
    const std::string_view having = head.header("if-none-match");
    if (was_304 || having == "*" || matches_tag(having, tag)) response.status = 304;
}

/// Compresses a body for a client that accepts it, and says so.
void set_encoding(const Head& head, bool was_304, Response& response) {
    const bool is_zipped = response.uncompressed_size > 0;
    const bool zips = response.compressible || is_zipped || !response.gzipped.empty() ||
                      response.body.size() >= compress_from;
    if (zips || was_304) response.headers.emplace_back("Vary", "Accept-Encoding");
    response.compressible = zips && accepts_gzip(head.header("accept-encoding"));
    if (!response.compressible || response.status == 304) return;
    response.headers.emplace_back("Content-Encoding", "gzip");
    if (response.stream || is_zipped) return;
    response.body = response.gzipped.empty() ? gzip(response.body) : std::string(response.gzipped);
}

}  // namespace

void complete(const Head& head, const std::string& request_id, Response& response) {
    auto& headers = response.headers;
    headers.emplace_back(
        "Date", fmt::format("{:%a, %d %b %Y %T GMT}", fmt::gmtime(std::time(nullptr))));
    headers.emplace_back("X-Request-ID", request_id);
    if (response.problem) response.body = response.problem->body(request_id);
    if (!response.timing.empty())
        headers.emplace_back("Server-Timing", server_timing(response.timing));
    // Without it a browser could guess the type and run the bytes as a script.
    headers.emplace_back("X-Content-Type-Options", "nosniff");
    const bool was_304 = response.status == 304;
    if (!response.stream) set_validators(head, was_304, response);
    set_encoding(head, was_304, response);
}

// --- Writing it ---

namespace {

/// httplib's view of an outbox. The answer's head waits for the bytes that follow it.
class OutboxStream : public httplib::Stream {
public:
    /// head: the request head that httplib reads; silent: see Response.
    OutboxStream(Outbox& outbox, std::string head, bool silent)
        : outbox_(outbox),
          head_(std::move(head)),
          silent_(silent) {}

    ssize_t read(char* data, std::size_t size) override {
        const std::size_t n = std::min(size, head_.size() - read_);
        std::memcpy(data, head_.data() + read_, n);
        read_ += n;
        return static_cast<ssize_t>(n);
    }
    ssize_t write(const char* data, std::size_t size) override {
        outbox_.add({data, size});
        if (std::exchange(head_written_, true)) {
            outbox_.send();
            if (!outbox_.wait_for_space()) return -1;
        }
        return static_cast<ssize_t>(size);
    }
    using httplib::Stream::write;
    bool is_readable() const override { return read_ < head_.size(); }
    bool is_writable() const override {
        return !(silent_ ? outbox_.client_has_closed() : outbox_.is_broken());
    }
    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    // httplib only compares it with the largest one for select(), which it never calls.
    socket_t socket() const override { return -1; }

private:
    Outbox& outbox_;
    const std::string head_;
    const bool silent_;
    std::size_t read_ = 0;
    bool head_written_ = false;
};

using Fill = std::function<void(httplib::Response&)>;

/// httplib's part: it writes heads and the frames of chunks, as its server does for a request. The
/// request it gets consists of what these depend on. The real one is read by head.hpp: httplib
/// would take heads that a proxy reads differently, decode "%0d" in header values, compress with
/// brotli for 2 s, and find the route only after the body.
class HeadWriter : public httplib::Server {
public:
    HeadWriter() {
        svr_sock_ = 0;  // never used; without one httplib would end each stream at once
        set_keep_alive_timeout(idle_time.count());  // announced to clients
        set_keep_alive_max_count(1000000);
        set_post_routing_handler([](const auto&, auto& out) {
            // The length of a 304 would be that of the known answer, not 0; parts are not sent.
            if (out.status == 304) out.headers.erase("Content-Length");
            out.headers.erase("Accept-Ranges");
        });
        // httplib's own handler would write an answer.
        set_exception_handler([](const auto&, auto&, std::exception_ptr thrown) {
            std::rethrow_exception(std::move(thrown));
        });
    }
    /// method: HEAD for the head alone. False if the answer was broken off.
    bool write(const char* method, bool keep_alive, bool silent, const Fill& fill, Outbox& outbox) {
        set_pre_routing_handler([&fill](const auto&, auto& out) {
            fill(out);
            return HandlerResponse::Handled;
        });
        const char* connection = keep_alive ? "" : "Connection: close\r\n";
        OutboxStream stream(
            outbox, fmt::format("{} / HTTP/1.1\r\n{}\r\n", method, connection), silent);
        return process(*this, stream);
    }

private:
    /// Later versions of httplib also take the addresses.
    template <class Self>
    static bool process(Self& self, httplib::Stream& stream) {
        bool closed = false;
        if constexpr (requires { self.process_request(stream, false, closed, nullptr); })
            return self.process_request(stream, false, closed, nullptr);
        else return self.process_request(stream, "", 0, "", 0, false, closed, nullptr);
    }
};

void set_head(httplib::Response& out, const Response& response) {
    out.status = response.status;
    for (const auto& [name, value] : response.headers) out.set_header(name, value);
}

class SinkWriter : public Writer {
public:
    explicit SinkWriter(httplib::DataSink& sink) : sink_(sink) {}
    bool write(std::string_view text) override {
        return text.empty() || sink_.write(text.data(), text.size());
    }
    bool connected() override { return sink_.is_writable(); }

private:
    httplib::DataSink& sink_;
};

class GzipWriter : public Writer {
public:
    explicit GzipWriter(Writer& out) : out_(out) {}
    bool write(std::string_view text) override { return out_.write(gzip_.add(text)); }
    bool connected() override { return out_.connected(); }
    bool end() { return out_.write(gzip_.add({}, true)); }

private:
    Writer& out_;
    Gzip gzip_;
};

bool write_stream(const Response& response, Writer& out) {
    if (!response.compressible) return response.stream(out);
    GzipWriter writer(out);
    return response.stream(writer) && writer.end();
}

void provide_stream(const Head& head, const Response& response, httplib::Response& out) {
    auto provide = [&response](std::size_t, httplib::DataSink& sink) {
        SinkWriter writer(sink);
        const bool whole = write_stream(response, writer);
        if (whole) sink.done();
        return whole;
    };
    const std::string& type = response.content_type;
    if (head.takes_chunks) out.set_chunked_content_provider(type, std::move(provide));
    else out.set_content_provider(type, std::move(provide));
}

}  // namespace

bool write(const Head& head, bool keep_alive, Response response, Outbox& outbox) {
    thread_local HeadWriter writer;
    const bool has_body = head.method != "HEAD" && response.status != 304;
    const auto fill = [&](httplib::Response& out) {
        set_head(out, response);
        const auto nothing = [](std::size_t, std::size_t, httplib::DataSink&) { return false; };
        if (response.stream) provide_stream(head, response, out);
        else if (response.body.empty()) out.set_header("Content-Type", response.content_type);
        else if (response.status != 304)
            out.set_content_provider(response.body.size(), response.content_type, nothing);
    };
    // The body of a finished answer goes to the outbox as it is.
    const bool in_pieces = response.stream && has_body;
    const char* const method = in_pieces ? "GET" : "HEAD";
    if (!writer.write(method, keep_alive, response.silent, fill, outbox)) return false;
    if (has_body && !in_pieces) outbox.add(std::move(response.body));
    return true;
}

}  // namespace vines::http
