// Whole numbers in texts.
#pragma once

#include <charconv>
#include <limits>
#include <optional>
#include <string_view>

namespace vines {

/// The whole number from `least` to `most` that a text of decimal digits stands for; empty for any
/// other text.
inline std::optional<std::size_t> whole_number(
    std::string_view text, std::size_t least = 0,
    std::size_t most = std::numeric_limits<std::size_t>::max()) {
    std::size_t value = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = fault == std::errc() && end == text.data() + text.size();
    return is_whole && value >= least && value <= most ? std::optional(value) : std::nullopt;
}

}  // namespace vines
