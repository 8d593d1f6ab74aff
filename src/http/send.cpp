#include "http/send.hpp"

#include <memory>

#include "http/encoding.hpp"

namespace vines::http {

namespace {

// Below this the time to compress costs more than the bytes.
constexpr std::size_t compress_from = 65536;

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

}  // namespace

void send(const httplib::Request& request, httplib::Response& out, Response response, bool close) {
    if (request.method == "GET" && response.status == 200) {
        const std::string tag = entity_tag(response.body);
        out.set_header("ETag", tag);
        // Kept for a year, or asked for again, with the tag.
        out.set_header(
            "Cache-Control", response.immutable ? "max-age=31536000, immutable" : "no-cache");
        if (request.get_header_value("If-None-Match").find(tag) != std::string::npos) {
            out.status = 304;
            return;
        }
    }
    if (response.body.size() >= compress_from || !response.gzipped.empty()) {
        out.set_header("Vary", "Accept-Encoding");
        if (accepts_gzip(request.get_header_value("Accept-Encoding"))) {
            response.body =
                response.gzipped.empty() ? gzip(response.body) : std::string(response.gzipped);
            out.set_header("Content-Encoding", "gzip");
        }
    }
    set_head(out, response);
    if (close) out.set_header("Connection", "close");
    // Through a content provider, which keeps the library from compressing by itself: brotli at its
    // slowest, 2 s for 1.7 MB.
    auto body = std::make_shared<const std::string>(std::move(response.body));
    out.set_content_provider(
        body->size(), response.content_type,
        [body, close](std::size_t offset, std::size_t, httplib::DataSink& sink) {
            const bool sent = sink.write(body->data() + offset, body->size() - offset);
            return sent && !close;
        });
}

void send_stream(const httplib::Request& request, httplib::Response& out, Response response) {
    const bool zip =
        response.compressible && accepts_gzip(request.get_header_value("Accept-Encoding"));
    if (response.compressible) out.set_header("Vary", "Accept-Encoding");
    if (zip) out.set_header("Content-Encoding", "gzip");
    // What comes in chunks the library would compress, too, once it has seen this.
    const_cast<httplib::Request&>(request).headers.erase("Accept-Encoding");
    set_head(out, response);
    const std::string type = response.content_type;
    out.set_chunked_content_provider(
        type, [response = std::move(response), zip](std::size_t, httplib::DataSink& sink) {
            SinkWriter writer(sink);
            const bool whole = zip ? write_gzipped(response, writer) : response.stream(writer);
            if (whole) sink.done();
            return whole;
        });
}

}  // namespace vines::http
