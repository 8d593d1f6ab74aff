// How the bytes of a body travel: compressed, or not at all where the client has them already.
#pragma once

#include <string>

namespace vines::http {

/// gzip, level 1: a third of the size in a tenth of level 6's time, for columns of numbers. Throws
/// std::runtime_error where zlib fails.
std::string gzip(const std::string& text);

/// Whether a request with this header Accept-Encoding takes gzip.
bool accepts_gzip(const std::string& accept_encoding);

/// The header ETag of a body, by FNV-1a of 64 bits: tells its versions apart, guards against
/// nothing.
std::string entity_tag(const std::string& body);

}  // namespace vines::http
