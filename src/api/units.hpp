// Units as records write them.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace vines::api {

/// No unit has more bytes.
inline constexpr std::size_t longest_unit = 32;

/// In one way of writing: lower case, without blanks, brackets, ^ and *, u for the Greek mu, digits
/// in place of superscripts.
std::string unit_spelling(std::string_view text);

/// Whether a cell is what stands in a row of units below the names: a unit, of whatever quantity,
/// or nothing.
bool is_unit(std::string_view text);

/// Whether a name may end in this one, which no quantity of a record is read in.
bool is_foreign_unit(std::string_view text);

}  // namespace vines::api
