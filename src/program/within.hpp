// The range of a flag's value.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <string>

namespace vines {

/// As CLI::Range, which takes a value that is no number (nan) for one inside.
template <class Value>
CLI::Validator within(Value from, Value to) {
    const std::string range = fmt::format("[{} - {}]", from, to);
    return CLI::Validator(
        [from, to, range](const std::string& text) -> std::string {
            Value value{};
            if (CLI::detail::lexical_cast(text, value) && value >= from && value <= to) return "";
            return fmt::format("\"{}\" is not in {}", text, range);
        },
        range);
}

}  // namespace vines
