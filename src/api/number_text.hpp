// Numbers as text: the shortest that reads back to the same bits, in the form that JSON has.
#pragma once

#include <cstddef>

namespace vines::api {

/// "-2.2250738585072014e-308", and what is overwritten behind a shorter one.
inline constexpr std::size_t room_for_number = 40;

/// Writes a number and returns its end: 1.0, 0.0001, 1e-05, 123456789012345.0, 1e+15, and null for
/// what is not finite. So the JSON library writes it, too, but not always as short. There is
/// room_for_number behind `to`.
char* write_number(char* to, double value);

}  // namespace vines::api
