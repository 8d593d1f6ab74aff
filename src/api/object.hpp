// Objects of an answer.
//
// Json{{"name", value}, ...} first makes an array of each member, and an object of the library's is
// a vector that copies its members where it grows, with all that they hold. Here they are moved.
#pragma once

#include <initializer_list>
#include <utility>

#include "api/schema/json.hpp"

namespace vines::api {

struct Member {
    const char* name;
    mutable Json value;  ///< moved out of the list, whose members are const
};

/// Makes room for so many members more.
inline void make_room(Json& object, std::size_t members) {
    auto& now = object.get_ref<Json::object_t&>();
    if (now.capacity() - now.size() >= members) return;
    Json::object_t larger;
    larger.reserve(now.size() + members);
    for (auto& [name, value] : now) larger.emplace_back(name, std::move(value));
    now.swap(larger);
}

/// Puts members behind those of an object, which has none of their names.
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
