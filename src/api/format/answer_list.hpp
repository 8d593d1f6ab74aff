// Lists of an answer, packed or not, as input of tables and array files.
#pragma once

#include <string>

#include "api/answer_json.hpp"

namespace vines::api {

/// Entries of one type. Valid as long as the value that it refers to.
class AnswerList {
public:
    /// The list of a packed value or of an array of numbers, flags or strings, which may hold
    /// nulls; nullopt for any other value.
    static std::optional<AnswerList> of(const Json& value);

    /// Packed::no: words.
    Packed packing() const { return packing_; }
    std::size_t size() const;
    /// The entries as they lie in memory; NaN and infinities stand for null.
    std::span<const std::uint8_t> bytes() const { return own_.empty() ? bytes_ : own_; }
    /// Strings; empty for null.
    const std::vector<std::string>& words() const { return words_; }
    /// Numbers in each entry: 1, 4 or 16.
    std::size_t width() const;

private:
    Packed packing_ = Packed::numbers;
    std::span<const std::uint8_t> bytes_;
    std::vector<std::uint8_t> own_;
    std::vector<std::string> words_;
};

/// Replaces infinities, which stand for null, by NaN.
void nan_for_null(std::span<std::uint8_t> doubles);

}  // namespace vines::api
