#include "api/schema/nearest_name.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

namespace vines::api {

namespace {

/// Beyond this no name was meant, and a distance takes time: the longest name of a field has 19
/// characters.
constexpr std::size_t longest_name = 64;

/// Levenshtein distance, without regard to case.
std::size_t distance(const std::string& a, const std::string& b) {
    std::vector<std::size_t> row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0]++;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = std::tolower(static_cast<unsigned char>(a[i - 1])) ==
                              std::tolower(static_cast<unsigned char>(b[j - 1]));
            const std::size_t next = std::min({row[j] + 1, row[j - 1] + 1, diagonal + !same});
            diagonal = std::exchange(row[j], next);
        }
    }
    return row.back();
}

}  // namespace

std::string nearest_name(std::span<const std::string> names, const std::string& name) {
    if (name.size() > longest_name) return "";
    const auto nearest = std::min_element(
        names.begin(), names.end(),
        [&](const auto& a, const auto& b) { return distance(name, a) < distance(name, b); });
    // One slip in three letters, and one in a short name.
    const std::size_t slips = std::max<std::size_t>(1, name.size() / 3);
    return distance(name, *nearest) <= slips ? *nearest : "";
}

std::string nearest_name(const FieldTable& table, const std::string& name) {
    std::vector<std::string> names;
    for (const Field& field : table) names.push_back(field.name);
    return nearest_name(names, name);
}

}  // namespace vines::api
