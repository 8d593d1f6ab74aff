#include "api/number_text.hpp"

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "api/shortest_decimal.hpp"

namespace vines::api {

namespace {

char* write_word(char* to, const char* word, std::size_t length) {
    std::memcpy(to, word, length);
    return to + length;
}

/// Eight digits, the first one in the lowest byte. Four, two and one of them at a time are divided
/// in the parts of one word: x/100 is 5243 x >> 19 below 10^4, x/10 is 103 x >> 10 below 100.
std::uint64_t eight_digits(std::uint64_t number) {
    std::uint64_t word = number / 10000 | number % 10000 << 32;
    std::uint64_t upper = (word * 5243 >> 19) & 0x0000007f0000007f;
    word = upper | (word - 100 * upper) << 16;
    upper = (word * 103 >> 10) & 0x000f000f000f000f;
    return upper | (word - 10 * upper) << 8;
}

void write_eight(char* to, std::uint64_t digits) {
    static_assert(std::endian::native == std::endian::little);
    digits |= 0x3030303030303030;
    std::memcpy(to, &digits, sizeof digits);
}

/// From 1e-4 to below 1e15, without an exponent.
char* write_plain(char* to, Decimal decimal) {
    constexpr std::uint64_t eight = 100000000;
    const std::uint64_t upper = decimal.digits / eight, first = upper / eight,
                        middle = eight_digits(upper % eight),
                        last = eight_digits(decimal.digits % eight);
    const int before_point = 16 + (first != 0) + decimal.exponent;
    if (before_point <= 0) {
        std::memcpy(to, "0.000", 5);
        to += 2 - before_point;
    }
    char* const point = to + before_point;
    *to = static_cast<char>('0' + first);
    to += first != 0;
    write_eight(to, middle);
    write_eight(to + 8, last);
    char* end = to + 16 - std::countl_zero(last) / 8;
    if (last == 0)
        while (end[-1] == '0') --end;
    if (before_point <= 0) return end;
    if (end <= point) return write_word(point, ".0", 2);
    char fraction[16];
    std::memcpy(fraction, point, sizeof fraction);
    std::memcpy(point + 1, fraction, sizeof fraction);
    *point = '.';
    return end + 1;
}

}  // namespace

char* write_number(char* to, double value) {
    const double size = std::abs(value);
    if (size >= 1e-4 && size < 1e15) {
        *to = '-';
        return write_plain(to + std::signbit(value), shortest_decimal(size));
    }
    if (value == 0)
        return std::signbit(value) ? write_word(to, "-0.0", 4) : write_word(to, "0.0", 3);
    if (!std::isfinite(value)) return write_word(to, "null", 4);
    return std::to_chars(to, to + room_for_number, value, std::chars_format::scientific).ptr;
}

}  // namespace vines::api
