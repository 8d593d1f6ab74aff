#include "api/json_text.hpp"

#include <algorithm>
#include <charconv>

namespace vines::api {

namespace {

/// Plain form of a number between 1e-4 and 1e15 that is not an integer. std::to_chars writes 17
/// digits in scientific form, "d.ddde-04" to "d.ddde+14", in 5/6 of its time for the plain form;
/// here only the point is moved.
char* write_fraction(char* to, double size) {
    // At most 16 digits follow the point; 16 are always copied.
    constexpr std::size_t digits = 16, exponent = 4;
    std::array<char, 48> text{};
    const char *const first = text.data(), *const behind_point = first + 2;
    const char* const end =
        std::to_chars(text.data(), text.data() + text.size(), size, std::chars_format::scientific)
            .ptr -
        exponent;
    const std::ptrdiff_t behind = end > behind_point ? end - behind_point : 0,
                         power = 10 * (end[2] - '0') + (end[3] - '0');
    if (end[1] == '-') {
        std::memcpy(to, "0.000", 5);
        to += 1 + power;
        *to = *first;
        std::memcpy(to + 1, behind_point, digits);
        return to + 1 + behind;
    }
    *to = *first;
    std::memcpy(to + 1, behind_point, digits);
    to[1 + power] = '.';
    std::memcpy(to + 2 + power, behind_point + power, digits);
    return to + 2 + behind;
}

// "-9223372036854775808"
constexpr std::size_t longest_integer = 20;

}  // namespace

char* write_number(char* to, double value) {
    if (!std::isfinite(value)) return std::copy_n("null", 4, to);
    const double size = std::abs(value);
    if (std::signbit(value)) *to++ = '-';
    if (size != 0 && !(size >= 1e-4 && size < 1e15))
        return std::to_chars(to, to + room_for_number - 1, size, std::chars_format::scientific).ptr;
    const auto whole = static_cast<std::int64_t>(size);
    if (static_cast<double>(whole) != size) return write_fraction(to, size);
    return std::copy_n(".0", 2, std::to_chars(to, to + room_for_number - 1, whole).ptr);
}

bool needs_no_escape(std::string_view text) {
    return std::all_of(text.begin(), text.end(), [](char c) {
        return c >= ' ' && c != '"' && c != '\\';  // char is signed: only ASCII
    });
}

std::size_t room_for_lists(const Json& json) {
    std::size_t most = 0;
    if (json.is_structured())
        for (const Json& part : json) most += room_for_lists(part);
    if (!json.is_binary()) return most;
    // Bytes of an entry. number: "-2.2250738585072014e-308", a comma, and a part of the brackets
    // around four.
    constexpr std::size_t number = 26, integer = longest_integer + 1, flag = 6;
    const std::size_t bytes = json.get_binary().size();
    switch (packing_of(json)) {
        case Packed::integers: return 2 + bytes / sizeof(int) * integer;
        case Packed::flags: return 2 + bytes * flag;
        default: return 2 + bytes / sizeof(double) * number;
    }
}

char* JsonText::room(std::size_t length) {
    if (piece_.size() - used_ < length) end();
    return piece_.data() + used_;
}

void JsonText::end() {
    if (used_ > 0) take_({piece_.data(), used_});
    used_ = 0;
}

void JsonText::put(char c) {
    *room(1) = c;
    ++used_;
}

void JsonText::put(std::string_view text) {
    while (!text.empty()) {
        char* const to = room(1);
        const std::size_t part = std::min(text.size(), piece_.size() - used_);
        std::memcpy(to, text.data(), part);
        used_ += part;
        text.remove_prefix(part);
    }
}

void JsonText::put_quoted(const std::string& text) {
    if (!needs_no_escape(text)) return put(std::string_view(Json(text).dump()));
    put('"');
    put(std::string_view(text));
    put('"');
}

void JsonText::put_number(double number) {
    char* const to = room(room_for_number);
    used_ += static_cast<std::size_t>(write_number(to, number) - to);
}

void JsonText::put_entry(char before, double entry) {
    char* const to = room(1 + room_for_number);
    *to = before;
    used_ += static_cast<std::size_t>(write_number(to + 1, entry) - to);
}

void JsonText::put_entry(char before, int entry) {
    char* const to = room(1 + longest_integer);
    *to = before;
    used_ +=
        static_cast<std::size_t>(std::to_chars(to + 1, to + 1 + longest_integer, entry).ptr - to);
}

void JsonText::put_entry(char before, bool entry) {
    put(before);
    put(std::string_view(entry ? "true" : "false"));
}

template <class Entry>
void JsonText::put_entry(char before, const std::array<Entry, 4>& entry) {
    put(before);
    before = '[';
    for (const Entry& part : entry) put_entry(std::exchange(before, ','), part);
    put(']');
}

void JsonText::put_list(const PackedList& list) {
    char before = '[';
    for_each_entry(list, [&](const auto& entry) { put_entry(std::exchange(before, ','), entry); });
    put(std::string_view(list.bytes.empty() ? "[]" : "]"));
}

void JsonText::write(Json& json) {
    using Type = Json::value_t;
    switch (json.type()) {
        case Type::object: {
            auto& members = json.get_ref<Json::object_t&>();
            char before = '{';
            for (auto& [name, value] : members) {
                put(std::exchange(before, ','));
                put_quoted(name);
                put(':');
                write(value);
            }
            put(std::string_view(members.empty() ? "{}" : "}"));
            return members.clear();
        }
        case Type::array: {
            auto& values = json.get_ref<Json::array_t&>();
            char before = '[';
            for (Json& value : values) {
                put(std::exchange(before, ','));
                write(value);
            }
            put(std::string_view(values.empty() ? "[]" : "]"));
            return values.clear();
        }
        case Type::binary:
            put_list(list_of_(json));
            json = nullptr;
            return;
        case Type::number_float: return put_number(json.get<double>());
        case Type::string: return put_quoted(json.get_ref<const std::string&>());
        case Type::boolean: return put(std::string_view(json.get<bool>() ? "true" : "false"));
        case Type::null: return put(std::string_view("null"));
        default: return put(std::string_view(json.dump()));
    }
}

PackedList list_in_memory(const Json& value) { return {packing_of(value), value.get_binary()}; }

std::string json_text(Json json) {
    std::string text;
    text.reserve(room_for_lists(json));
    JsonText out([&text](std::string_view piece) { text += piece; });
    out.write(json);
    out.end();
    return text;
}

}  // namespace vines::api
