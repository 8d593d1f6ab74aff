// Parses the text of requests: JSON bodies from untrusted clients, queries, and the encodings of
// measurement programs and spreadsheets.
#pragma once

#include <string_view>

#include "api/answer_json.hpp"
#include "api/cancellation.hpp"
#include "api/schema/field.hpp"

namespace vines::api {

/// How the lists of `record` and `impacts` are held.
enum class Columns : std::uint8_t {
    as_values,  ///< an array with a JSON value for each number
    packed      ///< an array of packed lists of numbers, for take_entries()
};

/// Parses a JSON object in linear time. Problem 400, with the position, for text that is not a JSON
/// object, for nesting deeper than 16 (the library overflows the stack at greater depth), and for
/// an object with more than 1000 names or a repeated one (the library would keep the last). Problem
/// 413 and Cancelled by `limits`.
Json parse_object(
    std::string_view text, const ReadLimits& limits = {}, Columns columns = Columns::as_values);

/// Length of a list of `record` or `impacts`.
std::size_t entries_of(const Json& list);

/// Calls take(index, number, value) for each entry of such a list and frees what it has read:
/// `number` is NaN for an entry that is no number, and `value` is that entry.
template <class Take>
void take_entries(Json& list, Take take) {
    std::size_t index = 0;
    for (Json& entry : list) {
        if (packing_of(entry) != Packed::numbers) {
            const double number = entry.is_number() ? entry.get<double>() : std::nan("");
            take(index++, number, entry);
            continue;
        }
        change_numbers(entry.get_binary(), [&](double number) {
            take(index++, number, Json());
            return number;
        });
        entry = nullptr;
    }
}

bool is_utf8(std::string_view bytes);

/// Converts to UTF-8 without byte order mark from UTF-16 (by its mark, or the zero bytes of its
/// first two characters), UTF-8 or else Latin-1. UTF-8 is not copied; other text is stored in
/// `room`.
std::string_view as_utf8(std::string_view bytes, std::string& room);

/// Names and values in their order.
using Query = std::vector<std::pair<std::string, std::string>>;

/// Splits at "&", each part at its first "=", and decodes: "+" is a blank, "%2C" a comma. Empty
/// parts are dropped; a part without "=" has the value "". A "%" that is not followed by two
/// hexadecimal digits stands for itself. Never fails; from_query() checks names and values.
Query parse_query(std::string_view text);

/// The fields as an object, typed by the table. Values that do not parse as their field's type, and
/// those of unknown names, stay text for check() to report. object.field is a field of that object.
/// Problem 400 for a repeated name.
Json from_query(const FieldTable& table, const Query& query);

}  // namespace vines::api
