// Subcommands that print data built into the program: `vines presets`, `parameters`, `openapi` and
// `example`.
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "api/json_text.hpp"
#include "api/openapi/openapi.hpp"
#include "api/presets.hpp"
#include "api/problem.hpp"
#include "api/schema/enum_names.hpp"
#include "api/schema/field.hpp"
#include "api/schema/tables.hpp"
#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "program/process.hpp"
#include "program/subcommand.hpp"

namespace vines::cli {

namespace {

/// A command that prints text(name), of all names if `name` is empty, or json().
Command with_listing(
    CLI::App* command, api::Json (*json)(), std::string (*text)(const std::string& name),
    const std::string& about_name, const std::string& examples) {
    struct Options {
        std::string name, format = "text";
    };
    const auto options = std::make_shared<Options>();
    command->add_option("name", options->name, about_name);
    command
        ->add_option(
            "--format", options->format,
            "text, or json: the service's answer, always the whole list")
        ->check(CLI::IsMember({"text", "json"}))
        ->capture_default_str();
    return with_exit_codes(
        command,
        [options, json, text] {
            print(options->format == "json" ? api::json_text(json()) + "\n" : text(options->name));
            return complete;
        },
        examples);
}

/// Throws Problem 422 for a name that is none of `known`, names or a table.
[[noreturn]] void refuse_name(const std::string& kind, const auto& known, const std::string& name) {
    throw api::Problem(
        422,
        "no " + kind + " has the name " + api::shortened(name) + api::did_you_mean(known, name));
}

std::string text_of(const api::Preset& p) {
    std::string text = fmt::format("{}, {}: {}\n", p.name, p.source, p.title);
    if (!p.note.empty()) text += p.note + "\n";
    for (const auto& [name, value] : p.parameters.items())
        text += fmt::format("  {} = {}\n", name, api::json_text(value));
    return text + fmt::format("vines simulate -p preset={} --plot\n", p.name);
}

std::string text_of_presets(const std::string& name) {
    std::size_t width = 0, source = 0;
    for (const api::Preset& p : api::presets()) {
        if (p.name == name) return text_of(p);
        width = std::max(width, p.name.size());
        source = std::max(source, p.source.size());
    }
    if (!name.empty())
        refuse_name("preset", api::texts_of(api::presets(), &api::Preset::name), name);
    std::string text;
    for (const api::Preset& p : api::presets())
        text += fmt::format("{:<{}}  {:<{}}  {}\n", p.name, width, p.source, source, p.title);
    return text;
}

using api::Field;
using api::FieldTable;

std::string line_of(const Field& f) {
    return fmt::format(
        "  {:<21} {:<14} {}\n", f.name, f.unit.empty() ? api::enum_name(f.type) : f.unit,
        f.description);
}

std::string text_of(const Field& f) {
    std::string text = line_of(f);
    const auto add = [&text](const char* what, const std::string& value) {
        text += fmt::format("    {:<8} {}\n", what, value);
    };
    const std::string plain =
        f.fallback.is_string() ? f.fallback.get<std::string>() : api::json_text(f.fallback);
    if (!f.symbol.empty()) add("symbol", f.symbol);
    add("default", f.fallback_note.empty() ? plain : f.fallback_note);
    if (f.range) add("range", fmt::format("[{}, {}]", f.range->minimum, f.range->maximum));
    else if (!f.choices.empty()) add("one of", api::joined(f.choices));
    for (const Field& part : f.fields) text += "  " + f.name + "." + line_of(part).substr(2);
    return text;
}

/// All fields, or a field in each table that has it. Throws Problem 422 if no table has it.
std::string text_of_fields(const std::string& name) {
    std::string text;
    FieldTable all;
    for (const auto& [key, title, table] : api::listed_tables) {
        const FieldTable& fields = table();
        all = std::move(all) + fields;
        if (!name.empty() && !api::find(fields, name)) continue;
        text += fmt::format("{}{}\n", text.empty() ? "" : "\n", title);
        for (const Field& f : fields)
            if (name.empty()) text += line_of(f);
            else if (f.name == name) text += text_of(f);
    }
    if (text.empty()) refuse_name("field", all, name);
    return text;
}

}  // namespace

Command add_presets(CLI::App& app) {
    return with_listing(
        app.add_subcommand("presets", "figures and tables of the paper, and machines"),
        api::describe_presets, text_of_presets, "show only this preset, with its parameters",
        "vines presets\nvines presets fig3\nvines presets --format json | jq length");
}

Command add_parameters(CLI::App& app) {
    return with_listing(
        app.add_subcommand("parameters", "the fields of requests"), api::describe_fields,
        text_of_fields, "show only this field, with its default and range",
        "vines parameters\nvines parameters b\n"
        "vines parameters --format json | jq '.fields[].name'");
}

Command add_openapi(CLI::App& app) {
    CLI::App* command = app.add_subcommand("openapi", "the OpenAPI document");
    add_examples(*command, "vines openapi | jq '.paths | keys'");
    return ended_by_signals({command, [] {
                                 print(api::openapi().dump(2) + "\n");
                                 return 0;
                             }});
}

Command add_example(CLI::App& app) {
    struct Options {
        std::string what, output;
    };
    const auto options = std::make_shared<Options>();
    CLI::App* command = app.add_subcommand("example", "an example record for identify");
    command
        ->add_option(
            "what", options->what,
            "record: 20 s of the paper's experiment, b = 15 mm, simulated with the noise of two "
            "sensors, as CSV")
        ->required()
        ->check(CLI::IsMember({"record"}));
    add_output(*command, options->output);
    return with_exit_codes(
        command,
        [options] {
            write_all(options->output, api::example_record());
            return complete;
        },
        "vines example record > record.csv");
}

}  // namespace vines::cli
