#include "api/number_text.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace vines::api {

namespace {

char* write_word(char* to, const char* word, std::size_t length) {
    std::memcpy(to, word, length);
    return to + length;
}

/// One that is not whole and lies between 1e-4 and 1e15, in the plain form. The library writes the
/// scientific one, "d.ddde-04" to "d.ddde+14", in five sixths of the time that it takes for the
/// plain one of 17 digits, and only its point is to be moved.
char* write_fraction(char* to, double size) {
    // No more than 16 digits stand behind the point: as many are moved, however many there are.
    constexpr std::size_t digits = 16, exponent = 4;
    std::array<char, 48> text{};
    const char *const first = text.data(), *const behind_point = first + 2;
    const char* const end =
        std::to_chars(text.data(), text.data() + text.size(), size, std::chars_format::scientific)
            .ptr -
        exponent;
    const std::ptrdiff_t behind = end > behind_point ? end - behind_point : 0,
                         power = 10 * (end[2] - '0') + (end[3] - '0');
    if (end[1] == '-') {
        std::memcpy(to, "0.000", 5);
        to += 1 + power;
        *to = *first;
        std::memcpy(to + 1, behind_point, digits);
        return to + 1 + behind;
    }
    *to = *first;
    std::memcpy(to + 1, behind_point, digits);
    to[1 + power] = '.';
    std::memcpy(to + 2 + power, behind_point + power, digits);
    return to + 2 + behind;
}

}  // namespace

char* write_number(char* to, double value) {
    if (!std::isfinite(value)) return write_word(to, "null", 4);
    const double size = std::abs(value);
    if (std::signbit(value)) *to++ = '-';
    if (size != 0 && !(size >= 1e-4 && size < 1e15))
        return std::to_chars(to, to + room_for_number - 1, size, std::chars_format::scientific).ptr;
    const auto whole = static_cast<std::int64_t>(size);
    if (static_cast<double>(whole) != size) return write_fraction(to, size);
    return write_word(std::to_chars(to, to + room_for_number - 1, whole).ptr, ".0", 2);
}

}  // namespace vines::api
