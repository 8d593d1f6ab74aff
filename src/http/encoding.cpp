#include "http/encoding.hpp"

#include <fmt/chrono.h>

#include "http/connection.hpp"

namespace vines::http {

// --- Formats ---

namespace {

/// Specificity of a media range for a type: 3 equal, 2 "text/*", 1 "*/*", 0 no match.
int exactness(std::string_view range, std::string_view type) {
    if (range == type) return 3;
    if (range == "*/*") return 1;
    const std::size_t kind = type.find('/') + 1;
    return range == std::string(type.substr(0, kind)) + "*" ? 2 : 0;
}

/// The weight of the most specific range that matches.
double weight_of(std::string_view type, std::string_view accept) {
    double weight = 0;
    int most = 0;
    while (!accept.empty()) {
        const auto [range, its_weight] = preference_of(next_part(accept, ','));
        const int exact = exactness(range, type);
        if (exact <= most) continue;
        most = exact;
        weight = its_weight;
    }
    return weight;
}

}  // namespace

api::Format accepted_format(std::string_view accept, std::span<const api::FormatName> formats) {
    if (accept.find_first_not_of(" \t,") == std::string_view::npos) return api::Format::json;
    const api::FormatName* best = nullptr;
    double most = 0;
    for (const api::FormatName& name : formats) {
        const double weight = weight_of(name.media_type, accept);
        if (weight > most) {
            most = weight;
            best = &name;
        }
    }
    if (best) return best->format;
    throw api::Problem(
        406, "Accept lists none of this server's formats: " +
                 api::joined(api::texts_of(formats, &api::FormatName::media_type)));
}

// --- Compression and ETags ---

Gzip::Gzip() {
    // For the default answer (1.4 MB) level 1 leaves 40 % of the size in 14 ms; level 2 the same in
    // 16 ms, level 4 38 % in 31 ms, level 6 38 % in 88 ms, level 9 37 % in 158 ms. Huffman coding
    // alone (Z_HUFFMAN_ONLY) leaves 46 % after 12 ms.
    constexpr int level = 1;
    // zlib's defaults, except for the gzip header.
    constexpr int window = 15, with_gzip_header = 16, memory = 8;
    if (deflateInit2(
            &stream_, level, Z_DEFLATED, window + with_gzip_header, memory, Z_DEFAULT_STRATEGY) !=
        Z_OK)
        throw std::runtime_error("zlib: deflateInit2");
}

Gzip::~Gzip() { deflateEnd(&stream_); }

std::string Gzip::add(std::string_view text, bool last) {
    std::string out;
    stream_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(text.data()));
    stream_.avail_in = static_cast<uInt>(text.size());
    const int flush = last ? Z_FINISH : Z_NO_FLUSH;
    int result = Z_OK;
    do {
        stream_.next_out = reinterpret_cast<Bytef*>(piece_.data());
        stream_.avail_out = static_cast<uInt>(piece_.size());
        result = deflate(&stream_, flush);
        if (result == Z_BUF_ERROR) result = Z_OK;  // no input was left
        out.append(piece_.data(), piece_.size() - stream_.avail_out);
    } while (result == Z_OK && stream_.avail_out == 0);
    if (result != (last ? Z_STREAM_END : Z_OK)) throw std::runtime_error("zlib: deflate");
    return out;
}

std::optional<std::string> gzip(std::string_view text, const std::function<bool()>& gives_up) {
    constexpr std::size_t piece = 1 << 20;  // takes 10 ms
    Gzip whole;
    std::string out;
    for (; text.size() > piece; text.remove_prefix(piece)) {
        if (gives_up()) return std::nullopt;
        out += whole.add(text.substr(0, piece));
    }
    if (gives_up()) return std::nullopt;
    return out + whole.add(text, true);
}

bool accepts_gzip(std::string_view accept_encoding) {
    std::optional<double> by_name, by_star;
    double identity = 0;  // if not listed, anything is preferred to it
    while (!accept_encoding.empty()) {
        const auto [coding, its_weight] = preference_of(next_part(accept_encoding, ','));
        if (coding == "gzip" || coding == "x-gzip") by_name = its_weight;
        if (coding == "*") by_star = its_weight;
        if (coding == "identity") identity = its_weight;
    }
    const double weight = by_name.value_or(by_star.value_or(0));
    return weight > 0 && weight >= identity;
}

std::string entity_tag(const std::string& body) {
    return fmt::format("W/\"{:.16}\"", api::sha256(body));
}

bool matches_tag(std::string_view if_none_match, std::string_view tag) {
    // Weak comparison: the client can leave out the W/.
    return if_none_match.find(tag.substr(tag.find('"'))) != std::string_view::npos;
}

bool compress(Response& response, const Request& request, const std::function<bool()>& gives_up) {
    const Head& head = request.head;
    if (response.body.size() < compress_from || !accepts_gzip(head.header("accept-encoding")))
        return true;
    // The tag belongs to the uncompressed body.
    if (response.tag.empty() && head.method != "POST") response.tag = entity_tag(response.body);
    std::optional<std::string> gzipped = gzip(response.body, gives_up);
    response.stays_plain = !gzipped;
    if (!gzipped) return false;
    response.uncompressed_size = response.body.size();
    response.body = std::move(*gzipped);
    return true;
}

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
    response.compressible =
        zips && !response.stays_plain && accepts_gzip(head.header("accept-encoding"));
    if (!response.compressible || response.status == 304) return;
    response.headers.emplace_back("Content-Encoding", "gzip");
    if (response.stream || is_zipped) return;
    response.body = response.gzipped.empty() ? *gzip(response.body) : std::string(response.gzipped);
}

}  // namespace

void complete(const Request& request, Response& response) {
    const Head& head = request.head;
    auto& headers = response.headers;
    headers.emplace_back(
        "Date", fmt::format("{:%a, %d %b %Y %T GMT}", fmt::gmtime(std::time(nullptr))));
    headers.emplace_back("X-Request-ID", request.id);
    if (response.problem) response.body = response.problem->body(request.id);
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

/// Status line and headers.
std::string head_text(const Head& head, bool keep_alive, const Response& response) {
    std::string text =
        fmt::format("HTTP/1.1 {} {}\r\n", response.status, api::reason_phrase(response.status));
    const auto add = [&text](std::string_view name, std::string_view value) {
        fmt::format_to(std::back_inserter(text), "{}: {}\r\n", name, value);
    };
    for (const auto& [name, value] : response.headers) add(name, value);
    if (keep_alive) add("Keep-Alive", fmt::format("timeout={}, max=1000000", idle_time.count()));
    else add("Connection", "close");
    const bool is_304 = response.status == 304;
    if (!is_304 || response.body.empty()) add("Content-Type", response.content_type);
    if (response.stream && head.takes_chunks) add("Transfer-Encoding", "chunked");
    else if (!response.stream && !is_304)
        add("Content-Length", std::to_string(response.body.size()));
    return text + "\r\n";
}

/// Sends the pieces of a stream, compressed if that is announced, as chunks (RFC 9112, 7.1), or in
/// HTTP/1.0 as they are.
class PieceWriter : public Writer {
public:
    PieceWriter(const Head& head, const Response& response, Outbox& outbox)
        : outbox_(outbox),
          in_chunks_(head.takes_chunks),
          silent_(response.silent) {
        if (response.compressible) gzip_.emplace();
    }
    bool write(std::string_view text) override {
        return gzip_ ? send_some(gzip_->add(text)) : send_some(text);
    }
    bool connected() override { return !outbox_.is_lost(silent_); }
    bool end() {
        if (gzip_ && !send_some(gzip_->add({}, true))) return false;
        return !in_chunks_ || send("");
    }

private:
    bool send_some(std::string_view text) {
        return text.empty() || send(text);  // an empty chunk ends the stream
    }
    bool send(std::string_view text) {
        outbox_.add(
            in_chunks_ ? fmt::format("{:x}\r\n{}\r\n", text.size(), text) : std::string(text));
        outbox_.send();
        return outbox_.wait_for_space();
    }

    Outbox& outbox_;
    const bool in_chunks_, silent_;
    std::optional<Gzip> gzip_;
};

}  // namespace

bool write(const Head& head, bool keep_alive, Response response, Outbox& outbox) {
    outbox.add(head_text(head, keep_alive, response));  // waits for the bytes that follow it
    if (head.method == "HEAD" || response.status == 304) return true;
    if (!response.stream) {
        outbox.add(std::move(response.body));
        return true;
    }
    PieceWriter out(head, response, outbox);
    return response.stream(out) && out.end();
}

}  // namespace vines::http
