// JSON Schema (2020-12) in a few words: what the keys of an answer hold.
#pragma once

#include <string>
#include <vector>

#include "api/schema/json.hpp"

namespace vines::api::document {

Json text();
Json flag();
Json number();
/// 0 or more.
Json whole();
Json constant(const std::string& word);
Json one_of(const std::vector<std::string>& words);
Json list_of(Json items);
/// Of so many entries.
Json list_of(Json items, int length);
/// Of numbers: a column of an answer.
Json numbers();
/// [from, to].
Json interval();
Json or_null(Json schema);
/// Of a schema among the components.
Json reference(const std::string& name);

/// A key of an object, and what it means.
struct Key {
    std::string name;
    Json schema;
    std::string description;
    bool required = true;
};
using Keys = std::vector<Key>;

/// One that is not in every answer.
Key optional(Key key);
Keys operator+(Keys keys, const Keys& more);

/// An object with these keys and no others.
Json object_of(const Keys& keys);
/// A name for each of the keys is known by the answer alone.
Json map_of(Json values);

}  // namespace vines::api::document
