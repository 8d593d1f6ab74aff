// The lists of an answer, whatever they are kept as: what a table or an array file is made of.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "api/column.hpp"

namespace vines::api {

/// Entries of one kind. Valid as long as the value that it is of.
class List {
public:
    /// Of a packed list, or of an array of numbers, flags or words, null among them; nothing of any
    /// other value.
    static std::optional<List> of(const Json& value);

    /// no: words.
    Packed packing() const { return packing_; }
    std::size_t size() const;
    /// As they lie in memory; what is not finite stands for null.
    std::span<const std::uint8_t> bytes() const { return own_.empty() ? bytes_ : own_; }
    /// Empty for null.
    const std::vector<std::string>& words() const { return words_; }
    /// Numbers in each entry: 1, 4 or 16.
    std::size_t width() const;

private:
    Packed packing_ = Packed::numbers;
    std::span<const std::uint8_t> bytes_;
    std::vector<std::uint8_t> own_;
    std::vector<std::string> words_;
};

/// Calls visit(path, list) for each list of an answer, in its order; a path has points between its
/// names. Lists of objects are left out.
void visit_lists(
    const Json& answer, const std::function<void(const std::string&, const List&)>& visit);

/// Puts NaN into doubles for all that stands for null.
void nan_for_null(std::span<std::uint8_t> doubles);

}  // namespace vines::api
