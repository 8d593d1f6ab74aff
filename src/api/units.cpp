#include "api/units.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

namespace vines::api {

std::string unit_spelling(std::string_view text) {
    if (text.size() > longest_unit) return "?";
    std::string spelling(text);
    for (const auto& [written, plain] :
         {std::pair("\u00b5", "u"), std::pair("\u03bc", "u"), std::pair("\u00b2", "2"),
          std::pair("\u207b", "-"), std::pair("\u00b7", "")})
        for (std::size_t at; (at = spelling.find(written)) != std::string::npos;)
            spelling.replace(at, std::string_view(written).size(), plain);
    std::erase_if(spelling, [](char c) {
        return std::string_view(" ^*()[]").find(c) != std::string_view::npos;
    });
    std::transform(spelling.begin(), spelling.end(), spelling.begin(), [](unsigned char c) {
        return std::tolower(c);
    });
    return spelling;
}

bool is_foreign_unit(std::string_view text) {
    static const std::set<std::string, std::less<>> foreign = {
        "nm",  "cm", "dm", "km", "mil", "in", "inch", "ft",    "us",    "ns",
        "min", "h",  "hz", "v",  "mv",  "mg", "gal",  "cm/s2", "mm/s2", "ft/s2",
        "s",   "ms", "m",  "mm", "um",  "g",  "m/s",  "mm/s"};
    return foreign.contains(unit_spelling(text));
}

bool is_unit(std::string_view text) {
    static const std::set<std::string, std::less<>> others = {
        "",  "-",   "1",    "sec",     "msec", "m/s2", "m_s2", "ms-2", "m/s/s", "n",
        "a", "deg", "degc", "\u00b0c", "k",    "pa",   "bar",  "%",    "rad",   "kn"};
    return is_foreign_unit(text) || others.contains(unit_spelling(text));
}

}  // namespace vines::api
