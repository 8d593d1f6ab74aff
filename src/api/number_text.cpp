#include "api/number_text.hpp"

#include <charconv>
#include <cmath>
#include <cstring>

namespace vines::api {

namespace {

char* write_word(char* to, const char* word, std::size_t length) {
    std::memcpy(to, word, length);
    return to + length;
}

}  // namespace

char* write_number(char* to, double value) {
    if (!std::isfinite(value)) return write_word(to, "null", 4);
    const double size = std::abs(value);
    const bool plain = value == 0 || (size >= 1e-4 && size < 1e15);
    const auto format = plain ? std::chars_format::fixed : std::chars_format::scientific;
    char* const end = std::to_chars(to, to + room_for_number, value, format).ptr;
    const bool whole = plain && size == std::trunc(size);
    return whole ? write_word(end, ".0", 2) : end;
}

}  // namespace vines::api
