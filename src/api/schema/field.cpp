#include "api/schema/field.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace vines::api {

Field::Field(std::string name_, FieldKind kind, Json fallback_, std::string description_)
    : FieldKind(std::move(kind)),
      name(std::move(name_)),
      description(std::move(description_)),
      fallback(std::move(fallback_)) {}

Field::Field(std::string name_, FieldKind kind, Note note, std::string description_)
    : Field(std::move(name_), std::move(kind), nullptr, std::move(description_)) {
    fallback_note = std::move(note.text);
}

FieldTable grouped(const char* group, FieldTable rows) {
    for (Field& row : rows) row.group = group;
    return rows;
}

FieldTable operator+(FieldTable table, const FieldTable& more) {
    table.insert(table.end(), more.begin(), more.end());
    return table;
}

const Field* find(const FieldTable& table, const std::string& name) {
    const auto field = std::ranges::find(table, name, &Field::name);
    return field == table.end() ? nullptr : &*field;
}

namespace {

/// Longer names are not compared, which saves time: field names are much shorter.
constexpr std::size_t max_compared_length = 64;

/// Levenshtein distance, ignoring case.
std::size_t distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower_case(a[i - 1]) == lower_case(b[j - 1]);
            const std::size_t next = std::min({row[j] + 1, row[j - 1] + 1, diagonal + !same});
            diagonal = std::exchange(row[j], next);
        }
    }
    return row.back();
}

/// The text as a finite number; otherwise the text, which check() reports.
Json number_or_text(const std::string& text) {
    double value;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
        return text;
    return value;
}

Json numbers_of(const std::string& text) {
    Json array = Json::array();
    for (const std::string& part : split(text, ',')) array.push_back(number_or_text(part));
    return array;
}

}  // namespace

std::string did_you_mean(std::span<const std::string> names, const std::string& name) {
    if (name.size() > max_compared_length) return "";
    const auto nearest = std::ranges::min_element(
        names, {}, [&name](const std::string& known) { return distance(name, known); });
    // Allows one typing error per three letters, at least one.
    const std::size_t errors = std::max<std::size_t>(1, name.size() / 3);
    return distance(name, *nearest) <= errors ? "; did you mean " + *nearest + "?" : "";
}

std::string did_you_mean(const FieldTable& table, const std::string& name) {
    return did_you_mean(texts_of(table, &Field::name), name);
}

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    if (text.empty()) return parts;
    for (std::size_t from = 0;;) {
        const std::size_t at = text.find(separator, from);
        parts.push_back(text.substr(from, at - from));
        if (at == std::string::npos) return parts;
        from = at + 1;
    }
}

Json value_of_text(FieldType type, const std::string& text) {
    switch (type) {
        case FieldType::number:
        case FieldType::integer: return number_or_text(text);
        case FieldType::choice: return text;
        case FieldType::choices: return split(text, ',');
        case FieldType::interval:
        case FieldType::numbers: return numbers_of(text);
        case FieldType::intervals: {
            Json array = Json::array();
            for (const std::string& part : split(text, ';')) array.push_back(numbers_of(part));
            return array;
        }
        case FieldType::integers:
        case FieldType::object:
        case FieldType::objects: return text;  // no form in a query: check() reports the text
    }
    return nullptr;
}

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t";
    text.remove_prefix(std::min(text.size(), text.find_first_not_of(blanks)));
    return text.substr(0, text.find_last_not_of(blanks) + 1);
}

std::string joined(const std::vector<std::string>& items) {
    return fmt::format("{}", fmt::join(items, ", "));
}

}  // namespace vines::api
