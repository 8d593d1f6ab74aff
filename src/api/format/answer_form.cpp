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

constexpr std::array always_told = {"version", "status", "warnings", "provenance"};

// Of the fields of an answer: more than any has.
constexpr std::size_t most_fields = 1000, longest_field = 200, longest_text = 16384;

/// What is kept of a value: all of it, or of its members these.
struct Kept {
    bool whole = false;
    std::map<std::string, Kept> members = {};

    void add(const std::string& path) {
        Kept* at = this;
        for (const std::string& name : split(path, '.')) at = &at->members[name];
        at->whole = true;
    }
};

/// Whether there is such a thing. A part that is null has none, and might have it another time.
bool has(const Json& value, std::span<const std::string> path) {
    if (path.empty() || value.is_null()) return true;
    if (value.is_array())
        return std::any_of(
            value.begin(), value.end(), [path](const Json& entry) { return has(entry, path); });
    return value.is_object() && value.contains(path[0]) && has(value[path[0]], path.subspan(1));
}

/// Keeps of an object, or of each in an array of them, what is to be kept; false: nothing.
bool keep(Json& value, const Kept& kept) {
    if (kept.whole || value.is_null()) return true;
    bool any = false;
    if (value.is_array())
        for (Json& entry : value) any = keep(entry, kept) || any;
    if (!value.is_object()) return any;
    Json rest = Json::object();
    for (auto& [name, member] : value.get_ref<Json::object_t&>()) {
        const auto found = kept.members.find(name);
        if (found != kept.members.end() && keep(member, found->second))
            rest[name] = std::move(member);
    }
    value = std::move(rest);
    return !value.empty();
}

/// The faults of the field fields that its type does not show.
std::vector<FieldError> check_fields(const Json& fields) {
    if (fields.size() > most_fields)
        return {
            {"/fields", fields.size(), Json::array({0, most_fields}),
             "fields may hold " + std::to_string(most_fields) + " names"}};
    for (std::size_t k = 0; k < fields.size(); ++k) {
        const std::size_t length = fields[k].get_ref<const std::string&>().size();
        if (length == 0 || length > longest_field)
            return {
                {"/fields/" + std::to_string(k), fields[k], nullptr,
                 "a name of a field has 1 to " + std::to_string(longest_field) + " bytes"}};
    }
    return {};
}

/// The parts of the answer that the fields name, of those that can be included.
Json included(const std::vector<std::string>& fields, const Field& include) {
    Json parts = Json::array();
    const auto names = [&fields](const std::string& part) {
        return std::any_of(fields.begin(), fields.end(), [&part](const std::string& field) {
            return field == part || field.starts_with(part + ".");
        });
    };
    for (const std::string& choice : include.choices)
        if (names(choice) || (choice == "impacts" && names("touches")))  // told with them
            parts.push_back(choice);
    return parts;
}

}  // namespace

AnswerForm take_form(Json& fields, const FieldTable& table) {
    Json form = Json::object();
    for (const Field& f : form_fields()) {
        if (!fields.contains(f.name)) continue;
        Json& value = fields[f.name];
        // As a query has it.
        if (value.is_string() && value.get_ref<const std::string&>().size() > longest_text)
            refuse(
                {{"/" + f.name, value, nullptr,
                  f.name + " has at most " + std::to_string(longest_text) + " bytes"}});
        form[f.name] = value.is_string() ? value_of_text(f.type, value) : std::move(value);
        fields.erase(f.name);
    }
    std::vector<FieldError> errors = check(form_fields(), form);
    if (errors.empty() && form.contains("fields")) errors = check_fields(form["fields"]);
    if (!errors.empty()) refuse(std::move(errors));
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
    Kept kept;
    for (const char* name : always_told) kept.add(name);
    for (const std::string& field : fields) {
        kept.add(field);
        if (field != "provenance" && !has(answer, split(field, '.')))
            answer["warnings"].push_back("fields: there is no " + field + " in this answer");
    }
    keep(answer, kept);
}

}  // namespace vines::api
