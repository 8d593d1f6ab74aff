#include "api/schema/echo.hpp"

#include <string>
#include <string_view>

namespace vines::api {

namespace {

constexpr std::size_t longest_text = 2 * longest_echo;

/// Depth first; each value has two bytes of the text or more.
Json beginning(const Json& value, std::size_t& left) {
    if (left > 0) --left;
    if (value.is_string()) {
        const std::string_view text = value.get_ref<const std::string&>();
        return std::string(text.substr(0, longest_text));
    }
    if (value.is_array()) {
        Json some = Json::array();
        for (std::size_t k = 0; k < value.size() && left > 0; ++k)
            some.push_back(beginning(value[k], left));
        return some;
    }
    if (!value.is_object()) return value;
    Json::object_t some;
    for (const auto& [name, member] : value.get_ref<const Json::object_t&>()) {
        if (left == 0) break;
        some.emplace_back(name.substr(0, longest_text), beginning(member, left));
    }
    return some;
}

}  // namespace

Json beginning_of(const Json& value) {
    std::size_t left = longest_echo;
    return beginning(value, left);
}

}  // namespace vines::api
