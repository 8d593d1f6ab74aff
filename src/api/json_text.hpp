// An answer as JSON text: its words and single numbers value by value, its packed lists straight
// from their numbers (column.hpp).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "api/column.hpp"

namespace vines::api {

/// The numbers of a list as they lie in memory.
struct PackedList {
    Packed packing;
    std::span<const std::uint8_t> bytes;
};

/// Makes lists that are to come, one after the other as they stand in an answer.
class ListSource {
public:
    virtual ~ListSource() = default;
    /// Valid until the next.
    virtual PackedList list(const ListToCome&) = 0;
};

/// Writes text in pieces.
class JsonText {
public:
    /// Takes one piece after the other.
    using Take = std::function<void(std::string_view)>;

    /// `source`: of an answer with lists to come.
    explicit JsonText(Take take, ListSource* source = nullptr)
        : take_(std::move(take)),
          source_(source) {}
    JsonText(const JsonText&) = delete;
    JsonText& operator=(const JsonText&) = delete;

    /// What is written is freed: lists at once, members with their object.
    void write(Json& json);
    /// Hands out what is left.
    void end();

private:
    void put(char c);
    void put(std::string_view text);
    void put_quoted(const std::string& text);
    void put_number(double number);
    /// An entry of a list, and the bracket or comma before it.
    void put_entry(char before, double entry);
    void put_entry(char before, int entry);
    void put_entry(char before, bool entry);
    template <class Entry>
    void put_entry(char before, const std::array<Entry, 4>& entry);
    template <class Entry>
    void put_list(std::span<const std::uint8_t> list);
    void put_list(const PackedList& list);
    /// Where so many more characters fit.
    char* room(std::size_t length);

    const Take take_;
    ListSource* const source_;
    std::array<char, 16384> piece_;
    std::size_t used_ = 0;
};

/// No fewer bytes than the packed lists of a value take as text.
std::size_t room_for_lists(const Json& json);

/// Whether a text stands between quotation marks as it is.
bool needs_no_escape(std::string_view text);

/// The whole text.
std::string json_text(Json json);

}  // namespace vines::api
