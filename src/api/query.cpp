#include "api/query.hpp"

#include <algorithm>
#include <charconv>

#include "api/problem.hpp"
#include "api/schema/text_value.hpp"
#include "api/text_encoding.hpp"

namespace vines::api {

namespace {

std::string decoded(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    for (std::size_t i = 0; i < text.size(); ++i) {
        unsigned char byte = 0;
        const char* const digits = text.data() + std::min(i + 1, text.size());
        const char* const end = text.data() + std::min(i + 3, text.size());
        if (text[i] == '%' && end - digits == 2 &&
            std::from_chars(digits, end, byte, 16).ptr == end) {
            out += static_cast<char>(byte);
            i += 2;
        } else {
            out += text[i] == '+' ? ' ' : text[i];
        }
    }
    return out;
}

}  // namespace

Query parse_query(std::string_view text) {
    Query pairs;
    while (!text.empty()) {
        const std::string_view part = text.substr(0, text.find('&'));
        text.remove_prefix(std::min(text.size(), part.size() + 1));
        if (part.empty()) continue;
        const std::size_t equals = std::min(part.find('='), part.size());
        pairs.emplace_back(
            decoded(part.substr(0, equals)),
            decoded(part.substr(std::min(equals + 1, part.size()))));
    }
    return pairs;
}

namespace {

/// Problem 400 where `whole`, the name as it stands in the query, has come before.
void add_text(
    Json& object, const std::string& whole, const FieldTable& table, const std::string& name,
    const std::string& text) {
    if (!object.is_object() || object.contains(name))
        throw Problem(400, "the name \"" + whole + "\" comes twice in the query");
    const Field* f = find(table, name);
    object[name] = f ? value_of_text(f->type, text) : Json(text);
}

}  // namespace

Json from_query(const FieldTable& table, const Query& query) {
    Json object = Json::object();
    for (const auto& [name, text] : query) {
        if (!is_utf8(name) || !is_utf8(text))
            throw Problem(400, "the query is not in UTF-8: " + shortened(name));
        const std::size_t point = name.find('.');
        const std::string outer = name.substr(0, point);
        const Field* f = point == std::string::npos ? nullptr : find(table, outer);
        if (!f || f->fields.empty()) {
            add_text(object, name, table, name, text);
            continue;
        }
        if (!object.contains(outer)) object[outer] = Json::object();
        add_text(object[outer], name, f->fields, name.substr(point + 1), text);
    }
    return object;
}

}  // namespace vines::api
