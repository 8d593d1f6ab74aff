// JSON values of an answer: lists of numbers, null for a number that does not exist, and objects.
//
// A packed list holds its numbers as they lie in memory, in a binary value of the JSON library
// whose subtype gives their type. It stands for the array that json_text() writes (json_text.hpp),
// in half of the memory of an array of JSON values.
//
// object() moves members. Json{{"name", value}, ...} makes an array of each member first, and an
// object of the library is a vector that copies its members, with their contents, when it grows.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "api/schema/field.hpp"
#include "core/motion/simulate.hpp"

namespace vines {

/// [from, to].
inline void to_json(api::Json& json, const Interval& interval) {
    json = {interval.from, interval.to};
}
inline void from_json(const api::Json& json, Interval& interval) {
    interval = {json[0].get<double>(), json[1].get<double>()};
}

}  // namespace vines

namespace vines::api {

inline Json finite_or_null(double value) {
    return std::isfinite(value) ? Json(value) : Json(nullptr);
}

/// The entry type of a packed list. The values of numbers and integers are the tags of CBOR's typed
/// arrays (RFC 8746, 2.1), little-endian, with which the library's to_cbor() writes them.
enum class Packed : std::uint8_t {
    no,          ///< not packed: an array of JSON values
    quadruples,  ///< of four doubles
    matrices,    ///< 4 x 4 doubles, by rows
    flags,
    integers = 78,
    numbers = 86  ///< doubles; NaN and infinities stand for null
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

/// Size of an entry in bytes.
inline std::size_t entry_size(Packed packing) {
    switch (packing) {
        case Packed::numbers: return sizeof(double);
        case Packed::quadruples: return sizeof(Quadruple);
        case Packed::matrices: return sizeof(MatrixByRows);
        case Packed::integers: return sizeof(int);
        default: return sizeof(bool);
    }
}

/// The list of value(e), or of the member `value`, for each element e; packed if the type allows.
template <class Elements, class Value = std::identity>
Json column(const Elements& elements, Value value = {}) {
    using Entry = std::decay_t<std::invoke_result_t<Value&, decltype(*std::begin(elements))>>;
    if constexpr (packing<Entry> == Packed::no) {
        Json values = Json::array();
        values.get_ref<Json::array_t&>().reserve(elements.size());
        for (const auto& e : elements) values.push_back(std::invoke(value, e));
        return values;
    } else {
        std::vector<std::uint8_t> bytes(elements.size() * sizeof(Entry));
        std::uint8_t* to = bytes.data();
        for (const auto& e : elements) {
            const Entry entry = std::invoke(value, e);
            std::memcpy(to, &entry, sizeof(Entry));
            to += sizeof(Entry);
        }
        return Json::binary(std::move(bytes), static_cast<std::uint8_t>(packing<Entry>));
    }
}

inline Packed packing_of(const Json& value) {
    return value.is_binary() ? static_cast<Packed>(value.get_binary().subtype()) : Packed::no;
}

/// Replaces each packed double by change(number).
template <class Change>
void change_numbers(std::span<std::uint8_t> bytes, Change change) {
    for (std::size_t at = 0; at < bytes.size(); at += sizeof(double)) {
        double number;
        std::memcpy(&number, bytes.data() + at, sizeof number);
        number = change(number);
        std::memcpy(bytes.data() + at, &number, sizeof number);
    }
}

struct Member {
    const char* name;
    mutable Json value;  ///< mutable: moved out of an initializer list, whose members are const
};

/// Reserves room for `members` more members.
inline void make_room(Json& object, std::size_t members) {
    auto& now = object.get_ref<Json::object_t&>();
    if (now.capacity() - now.size() >= members) return;
    Json::object_t larger;
    larger.reserve(now.size() + members);
    for (auto& [name, value] : now) larger.emplace_back(name, std::move(value));
    now.swap(larger);
}

/// Appends members to an object that has none of these names.
inline void append(Json& object, std::initializer_list<Member> members) {
    make_room(object, members.size());
    auto& to = object.get_ref<Json::object_t&>();
    for (const Member& member : members) to.emplace_back(member.name, std::move(member.value));
}

inline Json object(std::initializer_list<Member> members) {
    Json made = Json::object();
    append(made, members);
    return made;
}

}  // namespace vines::api
