// The shortest decimal number that reads back to the same double, and of several the closest: what
// std::to_chars writes, in a fifth of its time.
#pragma once

#include <cstdint>

namespace vines::api {

/// digits * 10^exponent, with zeros at the end: of a number that is not subnormal 16 digits or 17.
struct Decimal {
    std::uint64_t digits;  ///< below 10^17
    int exponent;
};

/// Of a positive, finite number: R. Giulietti, "The Schubfach way to render doubles" (2020), whose
/// names the function keeps.
Decimal shortest_decimal(double value);

}  // namespace vines::api
