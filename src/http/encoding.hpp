// The form in which an answer is sent (RFC 9110, 8): its format, chosen by Accept; its compression,
// chosen by Accept-Encoding; its ETag; its bytes.
#pragma once

#include <zlib.h>

#include <span>

#include "api/format/encode.hpp"
#include "http/message.hpp"
#include "http/outbox.hpp"

namespace vines::http {

/// The format that Accept prefers (RFC 9110, 12.5.1); the first one, JSON, among equals or if the
/// header is empty. Problem 406 if it accepts none.
api::Format accepted_format(
    std::string_view accept, std::span<const api::FormatName> formats = api::format_names);

/// gzip at level 1: for columns of numbers a third of the size in a tenth of level 6's time.
/// Nothing once gives_up() is true, polled before each MB. Throws std::runtime_error if zlib fails.
std::optional<std::string> gzip(
    std::string_view text, const std::function<bool()>& gives_up = [] { return false; });

/// Compresses a text that comes in pieces.
class Gzip {
public:
    Gzip();
    ~Gzip();
    Gzip(const Gzip&) = delete;
    Gzip& operator=(const Gzip&) = delete;
    /// Returns the compressed bytes available so far; with `last` all that remain. The text must be
    /// shorter than 4 GiB, the limit of zlib's counters.
    std::string add(std::string_view text, bool last = false);

private:
    z_stream stream_{};
    std::vector<char> piece_ = std::vector<char>(1 << 16);
};

/// True if Accept-Encoding (RFC 9110, 12.5.3) accepts gzip, by name or else by "*", and does not
/// prefer the uncompressed body. An empty header does not accept it.
bool accepts_gzip(std::string_view accept_encoding);

/// A weak ETag: the first 64 bits of the body's SHA-256.
std::string entity_tag(const std::string& body);

/// True if If-None-Match (RFC 9110, 13.1.2) lists the tag. The caller handles "*".
bool matches_tag(std::string_view if_none_match, std::string_view tag);

// Smallest body that is compressed, in bytes; below it compression takes longer than sending.
inline constexpr std::size_t compress_from = 65536;

/// Compresses the body in place if it is large enough and the client accepts gzip. Called where the
/// answer is computed, because a large body takes longer to compress than to send. False if
/// gives_up() returned true; it is polled before each MB.
bool compress(Response& response, const Request& request, const std::function<bool()>& gives_up);

/// Completes a response: ETag (304 if the client has it), compression if the body is large and the
/// client accepts it, the request's id. A stream has neither length nor ETag.
void complete(const Request& request, Response& response);

/// Adds a completed response to the outbox; a stream is computed meanwhile, and waits for its
/// client. False if it was broken off. keep_alive: as announced to the client.
bool write(const Head& head, bool keep_alive, Response response, Outbox& outbox);

}  // namespace vines::http
