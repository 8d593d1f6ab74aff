#include "api/format/answer_form.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <string_view>

#include "api/problem.hpp"
#include "api/schema/check.hpp"
#include "api/schema/tables.hpp"
#include "api/schema/text_value.hpp"

namespace vines::api {

namespace {

constexpr std::array always_told = {"version", "status", "warnings"};

using Path = std::vector<std::string>;

Path split(const std::string& text, char separator) {
    Path parts(1);
    for (const char c : text)
        if (c == separator) parts.emplace_back();
        else parts.back() += c;
    return parts;
}

/// What stands behind a name in each of the paths that begin with it; an empty one: all of it.
std::map<std::string, std::vector<Path>> by_name(const std::vector<Path>& paths) {
    std::map<std::string, std::vector<Path>> rest;
    for (const Path& path : paths) rest[path[0]].emplace_back(path.begin() + 1, path.end());
    return rest;
}

/// Whether there is such a thing. A part that is null has none, and might have it another time.
bool has(const Json& value, std::span<const std::string> path) {
    if (path.empty() || value.is_null()) return true;
    if (value.is_array())
        return std::any_of(
            value.begin(), value.end(), [path](const Json& entry) { return has(entry, path); });
    return value.is_object() && value.contains(path[0]) && has(value[path[0]], path.subspan(1));
}

/// Keeps of an object, or of each in an array of them, what the paths name.
void keep(Json& value, const std::vector<Path>& paths) {
    const auto is_whole = [](const Path& path) { return path.empty(); };
    if (std::any_of(paths.begin(), paths.end(), is_whole)) return;
    if (value.is_array())
        for (Json& entry : value) keep(entry, paths);
    if (!value.is_object()) return;
    const auto rest = by_name(paths);
    Json kept = Json::object();
    for (auto& [name, member] : value.get_ref<Json::object_t&>()) {
        if (!rest.contains(name)) continue;
        keep(member, rest.at(name));
        kept[name] = std::move(member);
    }
    value = std::move(kept);
}

/// The parts of the answer that the fields name, of those that can be included.
Json included(const std::vector<std::string>& fields, const Field& include) {
    Json parts = Json::array();
    for (const std::string& choice : include.choices)
        if (std::any_of(fields.begin(), fields.end(), [&choice](const std::string& field) {
                return field == choice || field.starts_with(choice + ".");
            }))
            parts.push_back(choice);
    return parts;
}

}  // namespace

AnswerForm take_form(Json& fields, const FieldTable& table) {
    Json form = Json::object();
    for (const Field& f : form_fields()) {
        if (!fields.contains(f.name)) continue;
        Json& value = fields[f.name];
        form[f.name] = value.is_string() ? value_of_text(f.type, value) : std::move(value);
        fields.erase(f.name);
    }
    if (std::vector<FieldError> errors = check(form_fields(), form); !errors.empty())
        refuse(std::move(errors));
    AnswerForm told;
    for (const FormatName& name : format_names)
        if (form.value("format", "") == name.word) told.format = name.format;
    if (form.contains("fields")) told.fields = form["fields"].get<std::vector<std::string>>();
    const Field* const include = find(table, "include");
    if (include && !told.fields.empty() && !fields.contains("include"))
        fields["include"] = included(told.fields, *include);
    return told;
}

void thin(Json& answer, const std::vector<std::string>& fields) {
    if (fields.empty()) return;
    std::vector<Path> kept;
    for (const char* name : always_told) kept.push_back({name});
    for (const std::string& field : fields) {
        kept.push_back(split(field, '.'));
        if (!has(answer, kept.back()))
            answer["warnings"].push_back(
                "fields: there is no " + shortened(field) + " in this answer");
    }
    keep(answer, kept);
}

}  // namespace vines::api
