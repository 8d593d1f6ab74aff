#include "api/schema/text_value.hpp"

#include <charconv>
#include <cmath>

namespace vines::api {

namespace {

/// The number that the whole of a text stands for, or the text.
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

std::vector<std::string> split(const std::string& text, char separator) {
    std::vector<std::string> parts;
    for (std::size_t from = 0, at; !text.empty(); from = at + 1) {
        at = text.find(separator, from);
        parts.push_back(text.substr(from, at - from));
        if (at == std::string::npos) break;
    }
    return parts;
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
        case FieldType::objects: return text;  // no text stands for one
    }
    return nullptr;
}

}  // namespace vines::api
