#include "http/send.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <memory>

#include "http/encoding.hpp"

namespace vines::http {

// --- The stream between httplib and a connection ---

namespace {

// Slowest acceptable client, in addition to its timeout: a slower one would occupy a thread for
// nothing. The second number applies while other requests wait for the thread.
constexpr double min_rate = 8192, min_rate_contended = 65536;  // bytes per second

// The timeout is shorter while requests wait for the thread; that is rechecked every poll_interval.
constexpr std::chrono::milliseconds contended_time(2000), poll_interval(500);

// Every answer begins with these bytes.
constexpr std::string_view status_line_begin = "HTTP/1.1 ";

}  // namespace

ssize_t SocketStream::read(char* data, std::size_t size) {
    const std::size_t n = std::min(size, head_.size() - read_);
    std::memcpy(data, head_.data() + read_, n);
    read_ += n;
    return static_cast<ssize_t>(n);
}

ssize_t SocketStream::write(const char* data, std::size_t size) {
    if (!head_written_) {
        head_written_ = true;
        buffered_.assign(data, size);
        buffered_.erase(0, written_);  // already sent by probe()
        return static_cast<ssize_t>(size);
    }
    const bool sent = send(buffered_, {data, size});
    buffered_.clear();
    return sent ? static_cast<ssize_t>(size) : -1;
}

bool SocketStream::finish() {
    const bool sent = send(buffered_, {});
    buffered_.clear();
    return sent;
}

bool SocketStream::has_left() {
    const Connection::PeerState peer_state = connection_.peer_state();
    if (peer_state == Connection::PeerState::half_closed) probe();
    return peer_state == Connection::PeerState::reset;
}

/// Sends the next byte of the answer's begin; the interval doubles each time. At most half of the
/// work for a client that has left is then wasted, and the nine bytes last for minutes.
void SocketStream::probe() {
    const auto now = std::chrono::steady_clock::now();
    if (head_written_ || written_ == status_line_begin.size() || now < probe_at_) return;
    const char* const byte = status_line_begin.data() + written_;
    if (::send(connection_.socket(), byte, 1, MSG_DONTWAIT | MSG_NOSIGNAL) == 1) ++written_;
    probe_at_ = now + probe_interval_;
    probe_interval_ *= 2;
}

bool SocketStream::send(std::string_view first, std::string_view second) {
    while (!failed_ && !(first.empty() && second.empty())) {
        const auto part = [](std::string_view text) {
            return iovec{const_cast<char*>(text.data()), text.size()};
        };
        std::array<iovec, 2> parts{part(first), part(second)};
        msghdr message{};
        message.msg_iov = parts.data();
        message.msg_iovlen = parts.size();
        const ssize_t n = ::sendmsg(connection_.socket(), &message, MSG_DONTWAIT | MSG_NOSIGNAL);
        if (n >= 0) {
            const auto sent = static_cast<std::size_t>(n);
            written_ += sent;
            const std::size_t of_first = std::min(sent, first.size());
            first.remove_prefix(of_first);
            second.remove_prefix(sent - of_first);
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) failed_ = !wait_until_writable();
        else failed_ = errno != EINTR;
    }
    return !failed_;
}

/// Remaining time in which the client need not read; a total, so that single bytes do not extend
/// it.
std::chrono::milliseconds SocketStream::time_left() const {
    const bool contended = timeout_.contended();
    const auto time = contended ? std::min(timeout_.time, contended_time) : timeout_.time;
    const std::chrono::duration<double> earned(
        static_cast<double>(written_) / (contended ? min_rate_contended : min_rate));
    return std::chrono::ceil<std::chrono::milliseconds>(time + earned - waited_);
}

bool SocketStream::wait_until_writable() {
    using Clock = std::chrono::steady_clock;
    for (;;) {
        const std::chrono::milliseconds left = time_left();
        if (left.count() <= 0 || timeout_.time.count() == 0) return false;
        const Clock::time_point began = Clock::now();
        pollfd state{connection_.socket(), POLLOUT, 0};
        const int ready =
            ::poll(&state, 1, static_cast<int>(std::min(left, poll_interval).count()));
        waited_ += Clock::now() - began;
        if (ready > 0) return !(state.revents & (POLLERR | POLLHUP));
        if (ready < 0 && errno != EINTR) return false;
    }
}

// --- Responses ---

namespace {

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

bool write_gzipped(const Response& response, Writer& out) {
    GzipWriter writer(out);
    return response.stream(writer) && writer.end();
}

void send_stream(const Head& head, httplib::Response& out, Response response) {
    const bool zip = response.compressible && accepts_gzip(head.header("accept-encoding"));
    if (response.compressible) out.set_header("Vary", "Accept-Encoding");
    if (zip) out.set_header("Content-Encoding", "gzip");
    const std::string type = response.content_type;
    auto provide = [response = std::move(response), zip](std::size_t, httplib::DataSink& sink) {
        SinkWriter writer(sink);
        const bool whole = zip ? write_gzipped(response, writer) : response.stream(writer);
        if (whole) sink.done();
        return whole;
    };
    if (head.takes_chunks) out.set_chunked_content_provider(type, std::move(provide));
    else out.set_content_provider(type, std::move(provide));
}

std::string server_timing(const Timing& timing) {
    std::string text;
    for (const auto& [name, ms] : timing)
        text += fmt::format("{}{};dur={:.3f}", text.empty() ? "" : ", ", name, ms);
    return text;
}

}  // namespace

void send(
    const Head& head, const std::string& request_id, httplib::Response& out, Response response) {
    out.set_header("Date", fmt::format("{:%a, %d %b %Y %T GMT}", fmt::gmtime(std::time(nullptr))));
    out.set_header("X-Request-ID", request_id);
    set_head(out, response);
    if (response.problem) response.body = response.problem->body(request_id);
    if (!response.timing.empty()) out.set_header("Server-Timing", server_timing(response.timing));
    // Without it a browser could guess the type and run the bytes as a script.
    out.set_header("X-Content-Type-Options", "nosniff");
    if (response.stream) return send_stream(head, out, std::move(response));
    const bool known = response.status == 304;
    const bool is_zipped = response.uncompressed_size > 0;
    const bool zips =
        is_zipped || !response.gzipped.empty() || response.body.size() >= compress_from;
    if (zips || known) out.set_header("Vary", "Accept-Encoding");
    const bool reads = head.method == "GET" || head.method == "HEAD";
    // Without it httplib would offer ranges.
    if (head.method == "HEAD") out.set_header("Accept-Ranges", "none");
    if (reads && (response.status == 200 || known)) {
        const std::string tag = response.tag.empty() ? entity_tag(response.body) : response.tag;
        out.set_header("ETag", tag);
        // Cached for a year, or revalidated with the tag.
        out.set_header(
            "Cache-Control", response.immutable ? "max-age=31536000, immutable" : "no-cache");
        const std::string_view having = head.header("if-none-match");
        if (known || having == "*" || matches_tag(having, tag)) {
            out.status = 304;
            return;
        }
    }
    if (zips && accepts_gzip(head.header("accept-encoding"))) {
        if (!is_zipped)
            response.body =
                response.gzipped.empty() ? gzip(response.body) : std::string(response.gzipped);
        out.set_header("Content-Encoding", "gzip");
    }
    // The content provider keeps httplib from compressing the body itself (brotli: 2 s for 1.7 MB).
    auto body = std::make_shared<const std::string>(std::move(response.body));
    out.set_content_provider(
        body->size(), response.content_type,
        [body](std::size_t offset, std::size_t, httplib::DataSink& sink) {
            return sink.write(body->data() + offset, body->size() - offset);
        });
}

}  // namespace vines::http
