// How the bytes of a body travel: compressed, or not at all where the client has them already.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace vines::http {

/// gzip, level 1: a third of the size in a tenth of level 6's time, for columns of numbers. Throws
/// std::runtime_error where zlib fails.
std::string gzip(const std::string& text);
/// Nothing once it is given up, which is asked before each MB.
std::optional<std::string> gzip(std::string_view text, const std::function<bool()>& gives_up);

/// The same of a text that comes in pieces.
class Gzip {
public:
    Gzip();
    ~Gzip();
    /// What can be told of the whole by now; with `last` all.
    std::string add(std::string_view text, bool last = false);

private:
    struct Stream;
    const std::unique_ptr<Stream> stream_;
};

/// Whether a request with this header Accept-Encoding takes gzip (RFC 9110, 12.5.3): by its name,
/// or by "*" where its name is not there, and would not rather have the body as it is. Empty: no.
bool accepts_gzip(std::string_view accept_encoding);

/// The header ETag of a body, by a hash after FNV-1a, of 64 bits at a time: tells its versions
/// apart, guards against nothing.
std::string entity_tag(const std::string& body);

/// Whether a request with this header If-None-Match (RFC 9110, 13.1.2) names the tag. ("*" is for
/// who knows that there is an answer.)
bool names_tag(std::string_view if_none_match, std::string_view tag);

}  // namespace vines::http
