#include "api/format/answer_request.hpp"

#include <algorithm>
#include <map>

namespace vines::api {

namespace {

constexpr std::array always_kept = {"version", "status", "warnings", "provenance"};

// Limits of the field `fields`: more than any answer has.
constexpr std::size_t most_fields = 1000, longest_field = 200, longest_option = 16384;

/// The selected part of a value: all of it, or these members.
struct Selection {
    bool whole = false;
    std::map<std::string, Selection> members = {};

    void add(const std::string& path) {
        Selection* at = this;
        for (const std::string& name : split(path, '.')) at = &at->members[name];
        at->whole = true;
    }
};

/// True if the path exists. A null part matches every path: it can have members in another answer.
bool has(const Json& value, std::span<const std::string> path) {
    if (path.empty() || value.is_null()) return true;
    if (value.is_array())
        return std::ranges::any_of(value, [path](const Json& entry) { return has(entry, path); });
    return value.is_object() && value.contains(path[0]) && has(value[path[0]], path.subspan(1));
}

/// Reduces an object, or each object of an array, to the selected members; false if none is left.
bool select(Json& value, const Selection& selection) {
    if (selection.whole || value.is_null()) return true;
    bool any = false;
    if (value.is_array())
        for (Json& entry : value) any = select(entry, selection) || any;
    if (!value.is_object()) return any;
    Json rest = Json::object();
    for (auto& [name, member] : value.get_ref<Json::object_t&>()) {
        const auto found = selection.members.find(name);
        if (found != selection.members.end() && select(member, found->second))
            rest[name] = std::move(member);
    }
    value = std::move(rest);
    return !value.empty();
}

/// Checks lengths in `fields`, which its type does not limit.
std::vector<FieldError> check_fields(const Json& fields) {
    if (fields.size() > most_fields)
        return {
            {"/fields", fields.size(), Json::array({0, most_fields}),
             "fields can hold at most " + std::to_string(most_fields) + " names"}};
    for (std::size_t k = 0; k < fields.size(); ++k) {
        const std::size_t length = fields[k].get_ref<const std::string&>().size();
        if (length == 0 || length > longest_field)
            return {
                {"/fields/" + std::to_string(k), fields[k], nullptr,
                 "the name of a field has 1 to " + std::to_string(longest_field) + " bytes"}};
    }
    return {};
}

/// The parts named by `fields` that can be included.
Json included(const std::vector<std::string>& fields, const Field& include) {
    Json parts = Json::array();
    const auto names = [&fields](const std::string& part) {
        return std::ranges::any_of(fields, [&part](const std::string& field) {
            return field == part || field.starts_with(part + ".");
        });
    };
    for (const std::string& choice : include.choices)
        if (names(choice) || (choice == "impacts" && names("touches")))  // a part of impacts
            parts.push_back(choice);
    return parts;
}

/// The count of numbers and strings in a value.
std::size_t count(const Json& value) {
    if (!value.is_structured()) return 1;
    std::size_t all = 0;
    for (const Json& entry : value) all += count(entry);
    return all;
}

/// The request's fields without the measurement. Their number is limited: each is copied and
/// checked several times, unlike a record's numbers.
Json without_record(const Json& fields, std::size_t most) {
    Json others = Json::object();
    std::size_t all = 0;
    for (const auto& [name, value] : fields.items()) {
        if (name == "record" || name == "impacts") continue;
        all += count(value);
        if (all > most)
            throw Problem(
                413, "the fields other than the record hold more than " + std::to_string(most) +
                         " numbers and strings");
        others[name] = value;
    }
    return others;
}

/// Removes the output options, form_fields(), from `fields` and returns them. Sets `include`, if
/// the request does not give it, to the parts that the option `fields` names.
AnswerForm take_form(Json& fields, const FieldTable& table) {
    Json form = Json::object();
    for (const Field& f : form_fields()) {
        if (!fields.contains(f.name)) continue;
        Json& value = fields[f.name];
        // A value of a query is text.
        if (value.is_string() && value.get_ref<const std::string&>().size() > longest_option)
            refuse(
                {{"/" + f.name, value, nullptr,
                  f.name + " has at most " + std::to_string(longest_option) + " bytes"}});
        form[f.name] = value.is_string() ? value_of_text(f.type, value) : std::move(value);
        fields.erase(f.name);
    }
    std::vector<FieldError> errors = check(form_fields(), form);
    if (errors.empty() && form.contains("fields")) errors = check_fields(form["fields"]);
    if (!errors.empty()) refuse(std::move(errors));
    AnswerForm result;
    result.format = format_in(form, format_names);
    if (form.contains("fields")) result.fields = form["fields"].get<std::vector<std::string>>();
    const Field* const include = find(table, "include");
    if (include && !result.fields.empty() && !fields.contains("include"))
        fields["include"] = included(result.fields, *include);
    return result;
}

/// Reduces an answer to the paths in `fields` and the keys that are always kept, with a warning for
/// each path that matches nothing. Empty `fields` keep everything.
void keep_fields(Json& answer, const std::vector<std::string>& fields) {
    if (fields.empty()) return;
    Selection selection;
    for (const char* name : always_kept) selection.add(name);
    for (const std::string& field : fields) {
        selection.add(field);
        if (field != "provenance" && !has(answer, split(field, '.')))
            answer["warnings"].push_back("fields: there is no " + field + " in this answer");
    }
    select(answer, selection);
}

Answer computed(SimulateRequest request, const AnswerForm& form, const ComputeOptions& options) {
    // Only JSON is written while its lists are generated.
    const bool is_text = form.format.value_or(Format::json) == Format::json;
    return simulate_in_parts(
        std::move(request), options.stop, options.most_bytes,
        is_text ? options.most_kept : everything, options.begins);
}

Answer computed(const ManifoldRequest& request, const AnswerForm&, const ComputeOptions& options) {
    return {.json = manifold_answer(request, options.stop)};
}

Answer computed(const IdentifyRequest& request, const AnswerForm&, const ComputeOptions& options) {
    return {
        .json = identify_answer(
            request, {.stop = options.stop.requested,
                      .reached = options.reached,
                      .most_impacts = options.most_fitted})};
}

}  // namespace

AnswerRequest read_answer_request(
    const std::string& route, Json fields, const MeasurementBody& body, const ReadLimits& limits) {
    const auto read = [&](const FieldTable& table, const Json& proven, auto read_computation) {
        Provenance provenance{.route = route, .request = canonical(proven)};
        AnswerForm form = take_form(fields, table);
        return AnswerRequest{read_computation(), std::move(form), std::move(provenance)};
    };
    if (route == "/v1/simulate")
        return read(simulate_fields(), fields, [&] { return read_simulate_request(fields); });
    if (route == "/v1/manifold")
        return read(manifold_fields(), fields, [&] { return read_manifold_request(fields); });
    if (route != "/v1/identify") throw Problem(422, "unknown route: " + shortened(route));
    const Json others = without_record(fields, limits.most_other_values);
    AnswerRequest request = read(identify_fields(), others, [&] {
        return body.is_columns ? read_identify_request(fields, body.text, limits)
                               : read_identify_request(std::move(fields), limits);
    });
    request.provenance.record = sha256(body.text);  // only of a valid record
    return request;
}

Answer compute_answer(AnswerRequest r, const ComputeOptions& options) {
    Answer answer = std::visit(
        [&](auto& request) { return computed(std::move(request), r.form, options); },
        r.computation);
    keep_fields(answer.json, r.form.fields);
    answer.provenance = std::move(r.provenance);
    if (answer.is_fitted) answer.provenance->answer_limit = options.most_bytes;
    return answer;
}

}  // namespace vines::api
