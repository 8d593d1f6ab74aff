#include "cli/request_fields.hpp"

#include <array>
#include <filesystem>

namespace vines::cli {

namespace {

using api::FieldTable;
using api::FieldType;
using api::Json;

std::pair<std::string, std::string> split_at_equals(
    const std::string& text, const std::string& flag, const std::string& example) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos)
        throw api::Problem(
            400,
            flag + " " + api::shortened(text) + ": not NAME=VALUE, as in " + flag + " " + example);
    return {text.substr(0, equals), text.substr(equals + 1)};
}

/// Parses the JSON value of a field. Duplicate names are refused, as in a file.
Json parsed(const std::string& name, const std::string& text) {
    try {
        return api::parse_object("{\"value\":" + text + "}")["value"];
    } catch (const api::Problem& problem) {
        throw api::Problem(400, name + ": " + problem.what());
    }
}

/// Lists and objects have no query syntax; their text is parsed as JSON.
Json fields_of_pairs(const api::Query& pairs, const FieldTable& table) {
    Json object = api::from_query(table, pairs);
    for (auto& [name, value] : object.items()) {
        const api::Field* const field = api::find(table, name);
        const bool may_be =
            field && (field->type == FieldType::integers || field->type == FieldType::object ||
                      field->type == FieldType::objects);
        if (!may_be || !value.is_string()) continue;
        const std::string text = value.get<std::string>();
        if (text.starts_with('[') || text.starts_with('{')) value = parsed(name, text);
    }
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

/// Returns whether a name, even a mistyped one, belongs to the table rather than to its base.
bool belongs_to(const FieldTable& table, const std::string& name) {
    const std::string outer = name.substr(0, name.find('.'));
    if (!api::find(table, "base") || api::find(table, outer)) return true;
    return !api::find(api::sweep_base_fields(), name) && !api::did_you_mean(table, name).empty();
}

[[noreturn]] void refuse_both(const std::string& name, const std::string& other) {
    throw api::Problem(400, name + " and " + api::shortened(other) + " exclude each other");
}

void set_axes(Json& object, const std::vector<std::string>& axes, const FieldTable& table) {
    if (object.contains("axes") && !axes.empty()) refuse_both("axes", "--axis");
    const bool has_one = api::find(table, "axis");
    if (has_one && axes.size() + object.contains("axis") > 1)
        throw api::Problem(400, "there is only one axis");
    for (const std::string& axis : axes)
        if (has_one) object["axis"] = axis_of(axis);
        else object["axes"].push_back(axis_of(axis));
}

}  // namespace

void add_request(CLI::App& command, RequestOptions& given) {
    add_file(command, "request", given.input, "file with the request as JSON; - or nothing: stdin");
    add_output(command, given.output);
    add_request_fields(command, given);
}

void add_request_fields(CLI::App& command, RequestOptions& given) {
    command.add_option(
        "--query,-q", given.query, "request fields as in a URL: 'preset=fig3&b=0.02'");
    command
        .add_option(
            "--parameter,-p", given.fields,
            "a request field; overrides that of the file: -p preset=fig3 -p b=0.02")
        ->type_name("FIELD")
        ->expected(1)
        ->take_all();
}

void add_format(
    CLI::App& command, RequestOptions& given, const FieldTable& table, const std::string& about) {
    const std::vector<std::string>& choices = api::find(table, "format")->choices;
    command
        .add_option(
            "--format", given.format,
            "format of the answer; default: the request's, or that of the output's extension, or " +
                choices.front() + about)
        ->check(CLI::IsMember(choices));
}

void add_plot_flag(CLI::App& command, RequestOptions& given) {
    command
        .add_flag(
            "--plot", given.plot, "draw plots instead, in the terminal or as SVG with -o FILE.svg")
        ->excludes(command.get_option("--format"));
}

void add_threads(CLI::App& command, RequestOptions& given) {
    command.add_option("--threads", given.threads, "number of threads; 0: one per core")
        ->capture_default_str()
        ->envname("VINES_COMPUTE_THREADS")
        ->check(number_between(0, 1024));
}

void add_format_of(const std::string& output, Json& request) {
    const std::string extension = std::filesystem::path(output).extension().string();
    if (!request.contains("format"))
        for (const char* format : {"csv", "cbor", "npz"})
            if (extension == std::string(".") + format) request["format"] = format;
}

Json given_fields(const RequestOptions& given, const FieldTable& table) {
    api::Query pairs = api::parse_query(given.query), own, base;
    for (const std::string& field : given.fields)
        pairs.push_back(split_at_equals(field, "-p", "b=0.02"));
    for (auto& pair : pairs) (belongs_to(table, pair.first) ? own : base).push_back(pair);
    Json object = fields_of_pairs(own, table);
    if (object.contains("base") && !base.empty()) refuse_both("base", base[0].first);
    set_axes(object, given.axes, table);
    if (!base.empty()) object["base"] = fields_of_pairs(base, api::sweep_base_fields());
    if (!given.format.empty()) object["format"] = given.format;
    return object;
}

Json read_request(const RequestOptions& given, const FieldTable& table) {
    Json request = given_fields(given, table);
    const bool is_given = !given.query.empty() || !given.fields.empty() || !given.axes.empty();
    if (!given.input.empty() || !is_given) {
        Json of_file = api::parse_object(read_all(given.input));
        of_file.merge_patch(request);
        request = std::move(of_file);
    }
    add_format_of(given.output, request);
    return request;
}

}  // namespace vines::cli
