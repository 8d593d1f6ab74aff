#include "api/shortest_decimal.hpp"

#include <array>
#include <bit>
#include <cstddef>

namespace vines::api {

namespace {

__extension__ using Wide = unsigned __int128;

/// A number of many bits, the lowest first.
constexpr int limbs = 36;
using Long = std::array<std::uint32_t, limbs>;

/// The first 128 bits of a number, rounded up.
struct First128 {
    std::uint64_t high, low;
};

constexpr First128 first_128(const Long& number, bool exact) {
    int top = limbs - 1;
    while (number[top] == 0) --top;
    const int shift = std::countl_zero(number[top]);
    const auto limb = [&](int k) { return k >= 0 ? std::uint64_t{number[k]} : 0; };
    const auto shifted = [&](int k) {  // 32 bits from limb k on
        return ((limb(k) << shift) | (limb(k - 1) << shift >> 32)) & 0xffffffff;
    };
    First128 first = {
        shifted(top) << 32 | shifted(top - 1), shifted(top - 2) << 32 | shifted(top - 3)};
    bool rest = !exact || (limb(top - 4) << shift & 0xffffffff) != 0;
    for (int k = top - 5; k >= 0 && !rest; --k) rest = number[k] != 0;
    if (rest && ++first.low == 0) ++first.high;
    return first;
}

// Of the powers 10^-292 to 10^324 those bits: 10^k lies between 2^127 and 2^128 times a power of 2.
constexpr int least_power = -292, greatest_power = 324;
using Powers = std::array<First128, greatest_power - least_power + 1>;

constexpr Powers powers_of_10() {
    Powers powers{};
    Long number{1};
    for (int k = 0; k <= greatest_power; ++k) {
        powers[k - least_power] = first_128(number, true);
        std::uint64_t carry = 0;
        for (std::uint32_t& limb : number) {
            carry += std::uint64_t{limb} * 10;
            limb = static_cast<std::uint32_t>(carry);
            carry >>= 32;
        }
    }
    // A power of 2 divided by 10 again and again, and rounded down each time, is rounded down once.
    number = {};
    number[limbs - 1] = 1u << 31;
    for (int k = -1; k >= least_power; --k) {
        std::uint64_t rest = 0;
        for (int i = limbs - 1; i >= 0; --i) {
            rest = rest << 32 | number[i];
            number[i] = static_cast<std::uint32_t>(rest / 10);
            rest %= 10;
        }
        powers[k - least_power] = first_128(number, false);
    }
    return powers;
}

constexpr Powers powers = powers_of_10();

// Right for the exponents of doubles.
constexpr int floor_log10_pow2(int e) { return (e * 1262611) >> 22; }
constexpr int floor_log10_three_quarters_pow2(int e) { return (e * 1262611 - 524031) >> 22; }
constexpr int floor_log2_pow10(int e) { return (e * 1741647) >> 19; }

/// A double as c 2^q, and the power of ten that makes 16 digits or 17 of it: 10^-k 2^q lies in
/// [1, 10), and is g 2^(h - 128).
struct Scaled {
    std::uint64_t c;
    int q, k, h;
    bool closer;  ///< to the double below than to the one above: a power of 2
    const First128& g;
};

Scaled scaled(double value) {
    constexpr int mantissa_bits = 52, bias = 1075;
    const auto bits = std::bit_cast<std::uint64_t>(value);
    const std::uint64_t fraction = bits & ((std::uint64_t{1} << mantissa_bits) - 1);
    const int biased = static_cast<int>(bits >> mantissa_bits);
    const std::uint64_t c = biased > 0 ? fraction | std::uint64_t{1} << mantissa_bits : fraction;
    const int q = biased > 0 ? biased - bias : 1 - bias;
    const bool closer = fraction == 0 && biased > 1;
    const int k = closer ? floor_log10_three_quarters_pow2(q) : floor_log10_pow2(q);
    return {c,      q,
            k,      q + floor_log2_pow10(-k) + 1,
            closer, powers[static_cast<std::size_t>(-k - least_power)]};
}

/// The upper 64 bits of g c / 2^64, the last of them 1 where anything is cut off.
std::uint64_t round_to_odd(const First128& g, std::uint64_t c) {
    const auto low = static_cast<std::uint64_t>(Wide{g.low} * c >> 64);
    const Wide product = Wide{g.high} * c + low;
    return static_cast<std::uint64_t>(product >> 64) | (static_cast<std::uint64_t>(product) > 1);
}

/// For every double.
Decimal schubfach(const Scaled& v) {
    // What rounds to the value lies between (c - 1/2) 2^q, or - 1/4 below a power of 2, and
    // (c + 1/2) 2^q; the ends belong to it where c is even.
    const std::uint64_t open = v.c & 1, cb = 4 * v.c, cbl = cb - 2 + v.closer, cbr = cb + 2;
    const std::uint64_t vbl = round_to_odd(v.g, cbl << v.h), vb = round_to_odd(v.g, cb << v.h),
                        vbr = round_to_odd(v.g, cbr << v.h), lower = vbl + open, upper = vbr - open;
    const std::uint64_t s = vb / 4, sp = s / 10;
    const bool up_inside = lower <= 40 * sp, wp_inside = 40 * sp + 40 <= upper;
    if (s >= 10 && up_inside != wp_inside) return {10 * (sp + wp_inside), v.k};
    const bool u_inside = lower <= 4 * s, w_inside = 4 * s + 4 <= upper;
    if (u_inside != w_inside) return {s + w_inside, v.k};
    const std::uint64_t middle = 4 * s + 2;
    return {s + (vb > middle || (vb == middle && (s & 1) != 0)), v.k};
}

}  // namespace

Decimal shortest_decimal(double value) {
    const Scaled v = scaled(value);
    // c 2^q 10^-k as s and a fraction of 2^-60, and its distance from the doubles half way to the
    // next: both to some units of 2^-60.
    constexpr int point = 60;
    constexpr std::uint64_t unit = std::uint64_t{1} << point, rounding = 8;
    const auto low = static_cast<std::uint64_t>(Wide{v.g.low} * (v.c << v.h) >> 64);
    const Wide product = Wide{v.g.high} * (v.c << v.h) + low;
    const auto s = static_cast<std::uint64_t>(product >> 64), sp = s / 10,
               fraction = static_cast<std::uint64_t>(product) >> (64 - point),
               half = v.g.high >> (5 - v.h);
    // Of the multiples of ten one at most is nearer than that: then it is the shortest. Else the
    // nearest whole number is. Which one it is cannot be foreseen: no branches.
    const std::uint64_t down = (s - 10 * sp) * unit + fraction, up = 10 * unit - down;
    const auto equal = [](std::uint64_t a, std::uint64_t b) {
        return a - b + rounding <= 2 * rounding;
    };
    if (v.closer || s < 10 || equal(down, half) || equal(up, half) || equal(fraction, unit / 2))
        return schubfach(v);
    const std::uint64_t is_down = down < half, is_up = up < half, tenfold = 10 * (sp + is_up),
                        single = s + (fraction > unit / 2);
    return {single ^ ((single ^ tenfold) & (0 - (is_down | is_up))), v.k};
}

}  // namespace vines::api
