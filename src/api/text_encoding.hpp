// Text encodings of measurement programs and spreadsheets.
#pragma once

#include <string>
#include <string_view>

namespace vines::api {

/// Converts to UTF-8 without byte order mark from UTF-16 (by its mark, or the zero bytes of its
/// first two characters), UTF-8 or else Latin-1. UTF-8 is not copied; other text is stored in
/// `room`.
std::string_view as_utf8(std::string_view bytes, std::string& room);

bool is_utf8(std::string_view bytes);

}  // namespace vines::api
