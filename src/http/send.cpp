#include "http/send.hpp"

#include <fmt/format.h>

#include <memory>

#include "http/compress.hpp"
#include "http/encoding.hpp"

namespace vines::http {

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
    bool present() override { return sink_.is_writable(); }

private:
    httplib::DataSink& sink_;
};

/// Compresses on the way to another one.
class GzipWriter : public Writer {
public:
    explicit GzipWriter(Writer& out) : out_(out) {}
    bool write(std::string_view text) override { return out_.write(gzip_.add(text)); }
    bool present() override { return out_.present(); }
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
    out.set_header("X-Request-ID", request_id);
    set_head(out, response);
    if (response.problem) response.body = response.problem->body(request_id);
    if (!response.timing.empty()) out.set_header("Server-Timing", server_timing(response.timing));
    // As what a browser would take the bytes for otherwise, they could be a script.
    out.set_header("X-Content-Type-Options", "nosniff");
    if (response.stream) return send_stream(head, out, std::move(response));
    const bool known = response.status == 304;
    const bool is_zipped = response.gzipped_from > 0;
    const bool zips =
        is_zipped || !response.gzipped.empty() || response.body.size() >= compress_from;
    if (zips || known) out.set_header("Vary", "Accept-Encoding");
    const bool reads = head.method == "GET" || head.method == "HEAD";
    // Else the library would promise parts of answers.
    if (head.method == "HEAD") out.set_header("Accept-Ranges", "none");
    if (reads && (response.status == 200 || known)) {
        const std::string tag = response.tag.empty() ? entity_tag(response.body) : response.tag;
        out.set_header("ETag", tag);
        // Kept for a year, or asked for again, with the tag.
        out.set_header(
            "Cache-Control", response.immutable ? "max-age=31536000, immutable" : "no-cache");
        const std::string_view having = head.header("if-none-match");
        if (known || having == "*" || names_tag(having, tag)) {
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
    // Through a content provider, which keeps the library from compressing by itself: brotli at its
    // slowest, 2 s for 1.7 MB.
    auto body = std::make_shared<const std::string>(std::move(response.body));
    out.set_content_provider(
        body->size(), response.content_type,
        [body](std::size_t offset, std::size_t, httplib::DataSink& sink) {
            return sink.write(body->data() + offset, body->size() - offset);
        });
}

}  // namespace vines::http
