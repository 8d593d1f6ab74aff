// Schemas of the words that several answers hold.
#pragma once

#include <algorithm>

#include "api/openapi/json_schema.hpp"
#include "api/schema/words.hpp"

namespace vines::api::document {

/// The words of an enumeration; null where one of them is.
template <class Enum>
Json word_of_any() {
    const auto table = words<Enum>();
    const bool has_null =
        std::any_of(table.begin(), table.end(), [](const auto& w) { return !w.word; });
    const Json schema = one_of(all_words<Enum>());
    return has_null ? or_null(schema) : schema;
}

/// I to VI, or none.
Json regime_name();
/// 1 or -1.
Json side();

}  // namespace vines::api::document
