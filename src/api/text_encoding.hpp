// The encodings in which measuring programs and spreadsheets write text.
#pragma once

#include <string>
#include <string_view>

namespace vines::api {

/// In UTF-8 and without a byte order mark: of UTF-16 (by its mark, or the zeros of its first two
/// characters), UTF-8, or else Latin-1. What is UTF-8 already is not copied; else `room` holds it.
std::string_view as_utf8(std::string_view bytes, std::string& room);

bool is_utf8(std::string_view bytes);

}  // namespace vines::api
