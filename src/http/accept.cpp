#include "http/accept.hpp"

#include <string>
#include <vector>

#include "api/problem.hpp"
#include "api/schema/joined.hpp"
#include "http/header_text.hpp"

namespace vines::http {

namespace {

/// How exactly a range names a type: 3 by itself, 2 by its kind ("text/*"), 1 as any, 0 not at all.
int exactness(std::string_view range, std::string_view type) {
    if (range == type) return 3;
    if (range == "*/*") return 1;
    const std::size_t kind = type.find('/') + 1;
    return range == std::string(type.substr(0, kind)) + "*" ? 2 : 0;
}

/// The weight of the range that names it most exactly.
double weight_of(std::string_view type, std::string_view accept) {
    double weight = 0;
    int most = 0;
    while (!accept.empty()) {
        const Preference preference = preference_of(next_part(accept, ','));
        const int exact = exactness(preference.name, type);
        if (exact <= most) continue;
        most = exact;
        weight = preference.weight;
    }
    return weight;
}

[[noreturn]] void refuse_all() {
    std::vector<std::string> types;
    for (const api::FormatName& name : api::format_names) types.push_back(name.media_type);
    throw api::Problem(406, "the answer comes as one of " + api::joined(types));
}

}  // namespace

api::Format accepted_format(std::string_view accept) {
    if (accept.find_first_not_of(" \t,") == std::string_view::npos) return api::Format::json;
    const api::FormatName* best = nullptr;
    double most = 0;
    for (const api::FormatName& name : api::format_names) {
        const double weight = weight_of(name.media_type, accept);
        if (weight > most) {
            most = weight;
            best = &name;
        }
    }
    if (!best) refuse_all();
    return best->format;
}

}  // namespace vines::http
