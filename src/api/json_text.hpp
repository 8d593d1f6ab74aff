// Writes an answer as JSON text. Packed lists (answer_json.hpp) are written directly from memory.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <string_view>

#include "api/answer_json.hpp"

namespace vines::api {

/// A list as it lies in memory.
struct PackedList {
    Packed packing;
    std::span<const std::uint8_t> bytes;
};

/// The list of a packed value.
PackedList list_in_memory(const Json& value);

/// Calls take(entry) for each entry of a list, in its type.
template <class Take>
void for_each_entry(const PackedList& list, Take take) {
    const auto take_all = [&]<class Entry>(Entry entry) {
        for (std::size_t at = 0; at < list.bytes.size(); at += sizeof entry) {
            std::memcpy(&entry, list.bytes.data() + at, sizeof entry);
            take(std::as_const(entry));
        }
    };
    switch (list.packing) {
        case Packed::numbers: return take_all(double());
        case Packed::quadruples: return take_all(Quadruple());
        case Packed::matrices: return take_all(MatrixByRows());
        case Packed::integers: return take_all(int());
        case Packed::flags: return take_all(bool());
        case Packed::no: return;
    }
}

/// Writes JSON text in pieces of up to 16 kB.
class JsonText {
public:
    /// Receives the pieces in order.
    using Take = std::function<void(std::string_view)>;
    /// Returns the list of a binary value, valid until the next call. The values come in the order
    /// of the answer.
    using ListOf = std::function<PackedList(const Json& value)>;

    explicit JsonText(Take take, ListOf list_of = list_in_memory)
        : take_(std::move(take)),
          list_of_(std::move(list_of)) {}
    JsonText(const JsonText&) = delete;
    JsonText& operator=(const JsonText&) = delete;

    /// Writes a value and frees it on the way: lists after they are written, members with their
    /// object.
    void write(Json& json);
    /// Passes on the last piece.
    void end();

private:
    void put(char c);
    void put(std::string_view text);
    void put_quoted(const std::string& text);
    void put_number(double number);
    /// An entry of a list after its bracket or comma.
    void put_entry(char before, double entry);
    void put_entry(char before, int entry);
    void put_entry(char before, bool entry);
    template <class Entry>
    void put_entry(char before, const std::array<Entry, 4>& entry);
    void put_list(const PackedList& list);
    /// Where `length` more characters fit.
    char* room(std::size_t length);

    const Take take_;
    const ListOf list_of_;
    std::array<char, 16384> piece_;
    std::size_t used_ = 0;
};

/// Upper bound of the text of all packed lists of a value, in bytes.
std::size_t room_for_lists(const Json& json);

/// True if a text needs no escapes in a JSON string.
bool needs_no_escape(std::string_view text);

/// The whole text; as a line, with its end.
std::string json_text(Json json);
inline std::string json_line(Json json) { return json_text(std::move(json)) + "\n"; }

/// Bytes that write_number() needs: "-2.2250738585072014e-308", and its overwriting beyond the end.
inline constexpr std::size_t room_for_number = 40;

/// Writes a number and returns its end: 1.0, 0.0001, 1e-05, 123456789012345.0, 1e+15; null for NaN
/// and infinities. The same form as the JSON library's, which is sometimes longer. Needs
/// room_for_number bytes at `to`.
char* write_number(char* to, double value);

}  // namespace vines::api
