#include "cli/request_fields.hpp"

#include <array>
#include <utility>

#include "api/format/encode.hpp"
#include "api/parse_object.hpp"
#include "api/problem.hpp"
#include "api/query.hpp"
#include "api/schema/nearest_name.hpp"
#include "api/schema/text_value.hpp"

namespace vines::cli {

namespace {

using api::FieldTable;
using api::FieldType;
using api::Json;

std::vector<std::string> format_words() {
    std::vector<std::string> words;
    for (const api::FormatName& name : api::format_names) words.emplace_back(name.word);
    return words;
}

std::pair<std::string, std::string> split_at_equals(
    const std::string& text, const std::string& flag, const std::string& example) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
        throw api::Problem(
            400,
            flag + " " + api::shortened(text) + ": not NAME=VALUE, as in " + flag + " " + example);
    return {text.substr(0, equals), text.substr(equals + 1)};
}

api::Query pairs_of(const RequestFields& given) {
    api::Query pairs = api::parse_query(given.query);
    for (const std::string& field : given.fields)
        pairs.push_back(split_at_equals(field, "-p", "b=0.02"));
    return pairs;
}

/// What of a name's value is JSON. Its names come once, as in a file.
Json parsed(const std::string& name, const std::string& text) {
    try {
        return api::parse_object("{\"value\":" + text + "}")["value"];
    } catch (const api::Problem& problem) {
        throw api::Problem(400, name + ": " + problem.what());
    }
}

/// Lists and objects, for which a query has no text, may be told as JSON.
void read_json_in_text(Json& object, const FieldTable& table) {
    for (auto& [name, value] : object.items()) {
        const api::Field* const field = api::find(table, name);
        const bool may_be =
            field && (field->type == FieldType::integers || field->type == FieldType::object ||
                      field->type == FieldType::objects);
        if (!may_be || !value.is_string()) continue;
        const std::string text = value.get<std::string>();
        if (text.starts_with('[') || text.starts_with('{')) value = parsed(name, text);
    }
}

Json fields_of_pairs(const api::Query& pairs, const FieldTable& table) {
    Json object = api::from_query(table, pairs);
    read_json_in_text(object, table);
    return object;
}

Json axis_of(const std::string& text) {
    const auto [name, values] = split_at_equals(text, "--axis", "b=0.01:0.03:41");
    Json axis = {{"parameter", name}};
    if (values.find(':') == std::string::npos) {
        axis["values"] = api::value_of_text(FieldType::numbers, values);
        return axis;
    }
    const std::vector<std::string> parts = api::split(values, ':');
    constexpr std::array names = {"from", "to", "count", "scale"};
    if (parts.size() < 3 || parts.size() > names.size())
        throw api::Problem(
            400, "--axis " + api::shortened(text) +
                     ": not NAME=FROM:TO:COUNT, NAME=FROM:TO:COUNT:log or NAME=A,B,C");
    for (std::size_t k = 0; k < parts.size(); ++k)
        axis[names[k]] = k < 3 ? api::value_of_text(FieldType::number, parts[k]) : Json(parts[k]);
    return axis;
}

/// Of what a mistyped name was meant to be of.
bool is_of_sweep(const std::string& name) {
    const std::string outer = name.substr(0, name.find('.'));
    if (api::find(api::sweep_fields(), outer)) return true;
    return !api::find(api::sweep_base_fields(), name) &&
           !api::nearest_name(api::sweep_fields(), name).empty();
}

[[noreturn]] void comes_twice(const std::string& name, const std::string& other) {
    throw api::Problem(400, name + " holds " + api::shortened(other) + ": not both");
}

Json given_sweep(const RequestFields& given) {
    api::Query own, base;
    for (auto& pair : pairs_of(given)) (is_of_sweep(pair.first) ? own : base).push_back(pair);
    Json object = fields_of_pairs(own, api::sweep_fields());
    if (object.contains("base") && !base.empty()) comes_twice("base", base[0].first);
    if (object.contains("axes") && !given.axes.empty()) comes_twice("axes", "--axis");
    if (!base.empty()) object["base"] = fields_of_pairs(base, api::sweep_base_fields());
    for (const std::string& axis : given.axes) object["axes"].push_back(axis_of(axis));
    return object;
}

Json with_file(const Files& files, const RequestFields& given, const Json& fields) {
    if (files.input.empty() && given.is_given()) return fields;
    Json request = api::parse_object(read_all(files.input));
    request.merge_patch(fields);
    return request;
}

}  // namespace

void add_request_fields(CLI::App& command, RequestFields& given) {
    command.add_option(
        "--query,-q", given.query, "fields of the request as in a URL: 'preset=fig3&b=0.02'");
    command
        .add_option(
            "--parameter,-p", given.fields,
            "a field of the request, over that of its file: -p preset=fig3 -p b=0.02")
        ->type_name("FIELD")
        ->expected(1)
        ->take_all();
}

void add_format(CLI::App& command, RequestFields& given) {
    command.add_option("--format", given.format, "of the answer, json unless the request says so")
        ->check(CLI::IsMember(format_words()));
}

void add_axes(CLI::App& command, RequestFields& given) {
    command
        .add_option(
            "--axis,-a", given.axes,
            "an axis: b=0.01:0.03:41 (from, to, how many; :log), or b=0.01,0.02,0.03")
        ->type_name("AXIS")
        ->expected(1)
        ->take_all();
}

Json given_fields(const RequestFields& given, const FieldTable& table) {
    Json object = fields_of_pairs(pairs_of(given), table);
    if (!given.format.empty()) object["format"] = given.format;
    return object;
}

Json read_request(const Files& files, const RequestFields& given, const FieldTable& table) {
    return with_file(files, given, given_fields(given, table));
}

Json read_sweep(const Files& files, const RequestFields& given) {
    return with_file(files, given, given_sweep(given));
}

}  // namespace vines::cli
