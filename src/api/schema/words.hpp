// The words of requests and answers for the core's enumerations: one table for each.
#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "api/schema/field.hpp"
#include "core/measurement/unknowns.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

template <class Enum>
struct Word {
    Enum value;
    const char* word;  ///< null where the answer has null
};

template <class Enum>
std::span<const Word<Enum>> words();

template <>
std::span<const Word<FieldType>> words();
template <>
std::span<const Word<Damping>> words();
template <>
std::span<const Word<Status>> words();
template <>
std::span<const Word<Verdict>> words();
template <>
std::span<const Word<SectionKind>> words();
template <>
std::span<const Word<Carry>> words();
/// Of those that a request can fix.
template <>
std::span<const Word<Unknown>> words();

template <class Enum>
const char* word_of(Enum value) {
    for (const auto& w : words<Enum>())
        if (w.value == value) return w.word;
    throw std::logic_error("a value without a word");
}

/// As it stands in an answer.
template <class Enum>
Json word(Enum value) {
    const char* text = word_of(value);
    return text ? Json(text) : Json(nullptr);
}

/// Of a word that the table of fields allows.
template <class Enum>
Enum value_of(std::string_view word) {
    for (const auto& w : words<Enum>())
        if (w.word && word == w.word) return w.value;
    throw std::logic_error("no value for the word " + std::string(word));
}

/// All words, in the order of the table.
template <class Enum>
std::vector<std::string> all_words() {
    std::vector<std::string> list;
    for (const auto& w : words<Enum>())
        if (w.word) list.push_back(w.word);
    return list;
}

}  // namespace vines::api
