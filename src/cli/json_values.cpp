#include "cli/json_values.hpp"

namespace vines::cli {

namespace {

// Several times the depth of any answer. The limit bounds the stack: the JSON library copies a
// value recursively.
constexpr int max_depth = 64;

bool is_too_deep(std::string_view text) {
    int depth = 0;
    bool in_text = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        const char c = text[k];
        if (c == '"') in_text = !in_text;
        else if (in_text) k += c == '\\';
        else if ((c == '[' || c == '{') && ++depth > max_depth) return true;
        else if (c == ']' || c == '}') --depth;
    }
    return false;
}

}  // namespace

api::Json parse_answer(std::string_view text) {
    if (is_too_deep(text)) return api::Json::value_t::discarded;
    return api::Json::parse(text, nullptr, false);
}

}  // namespace vines::cli
