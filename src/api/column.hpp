// Numbers as they stand in an answer: lists of them, and null for a number that does not exist.
//
// A list is kept as its numbers lie in memory, in a binary value of the JSON library, whose subtype
// says what they are. It stands for the array that json_text() writes of it (json_text.hpp), in
// half of the memory of an array of JSON values.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/schema/json.hpp"

namespace vines::api {

inline Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

template <class Value>
Json or_null(const std::optional<Value>& value) {
    return value ? Json(*value) : Json(nullptr);
}

/// What the entries of a packed list are.
enum class Packed : std::uint8_t {
    no,          ///< it is an array of JSON values
    numbers,     ///< doubles; what is not finite stands for null
    quadruples,  ///< of such
    matrices,    ///< 4 x 4 of such, by rows
    integers,
    flags,
    to_come  ///< made while it is written: a ListToCome
};

using Quadruple = std::array<double, 4>;
using MatrixByRows = std::array<Quadruple, 4>;

template <class Entry>
inline constexpr Packed packing = std::is_same_v<Entry, double>         ? Packed::numbers
                                  : std::is_same_v<Entry, Quadruple>    ? Packed::quadruples
                                  : std::is_same_v<Entry, MatrixByRows> ? Packed::matrices
                                  : std::is_same_v<Entry, int>          ? Packed::integers
                                  : std::is_same_v<Entry, bool>         ? Packed::flags
                                                                        : Packed::no;

/// Bytes of an entry.
inline std::size_t entry_size(Packed packing) {
    switch (packing) {
        case Packed::numbers: return sizeof(double);
        case Packed::quadruples: return sizeof(Quadruple);
        case Packed::matrices: return sizeof(MatrixByRows);
        case Packed::integers: return sizeof(int);
        default: return sizeof(bool);
    }
}

/// One value for each element.
template <class Elements, class Value>
Json column(const Elements& elements, Value value) {
    using Entry = std::decay_t<decltype(value(*std::begin(elements)))>;
    if constexpr (packing<Entry> == Packed::no) {
        Json values = Json::array();
        values.get_ref<Json::array_t&>().reserve(elements.size());
        for (const auto& e : elements) values.push_back(value(e));
        return values;
    } else {
        std::vector<std::uint8_t> bytes(elements.size() * sizeof(Entry));
        std::uint8_t* to = bytes.data();
        for (const auto& e : elements) {
            const Entry entry = value(e);
            std::memcpy(to, &entry, sizeof(Entry));
            to += sizeof(Entry);
        }
        return Json::binary(std::move(bytes), static_cast<std::uint8_t>(packing<Entry>));
    }
}

/// Each of them.
template <class Elements>
Json column(const Elements& elements) {
    return column(elements, [](const auto& e) { return e; });
}

/// The packing of a value of an answer.
inline Packed packing_of(const Json& value) {
    return value.is_binary() ? static_cast<Packed>(value.get_binary().subtype()) : Packed::no;
}

/// In the place of a list that is too long to be kept: which column it is, and by what its numbers
/// are multiplied.
struct ListToCome {
    int column;
    double factor;
};

inline Json to_come(const ListToCome& list) {
    std::vector<std::uint8_t> bytes(sizeof list);
    std::memcpy(bytes.data(), &list, sizeof list);
    return Json::binary(std::move(bytes), static_cast<std::uint8_t>(Packed::to_come));
}

/// Of a value that is one.
inline ListToCome list_to_come(const Json& value) {
    ListToCome list;
    std::memcpy(&list, value.get_binary().data(), sizeof list);
    return list;
}

/// Puts another number in the place of each in packed doubles.
template <class Change>
void change_numbers(std::span<std::uint8_t> bytes, Change change) {
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(double)) {
        double number;
        std::memcpy(&number, bytes.data() + at, sizeof number);
        number = change(number);
        std::memcpy(bytes.data() + at, &number, sizeof number);
    }
}

}  // namespace vines::api
