// `vines parameters`: the fields of requests.
#include "api/schema/parameters.hpp"

#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/json_text.hpp"
#include "api/schema/joined.hpp"
#include "api/schema/nearest_name.hpp"
#include "api/schema/tables.hpp"
#include "api/schema/words.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/listing.hpp"
#include "program/print.hpp"

namespace vines::cli {

namespace {

using api::Field;
using api::FieldTable;

const std::vector<std::pair<const char*, const FieldTable&>>& tables() {
    static const std::vector<std::pair<const char*, const FieldTable&>> list = {
        {"simulate", api::simulate_fields()}, {"manifold", api::manifold_fields()},
        {"sweep", api::sweep_fields()},       {"an axis of a sweep", api::axis_fields()},
        {"identify", api::identify_fields()}, {"any answer", api::form_fields()}};
    return list;
}

std::string fallback_of(const Field& f) {
    if (!f.fallback_note.empty()) return f.fallback_note;
    return f.fallback.is_string() ? f.fallback.get<std::string>() : api::json_text(f.fallback);
}

std::string range_of(const Field& f) {
    if (f.range) return fmt::format("[{:g}, {:g}]", f.range->minimum, f.range->maximum);
    return api::joined(f.choices);
}

std::string line_of(const Field& f) {
    return fmt::format(
        "  {:<21} {:<14} {}\n", f.name, f.unit.empty() ? api::word_of(f.type) : f.unit,
        f.description);
}

std::string all_fields() {
    std::string text;
    for (const auto& [what, table] : tables()) {
        text += fmt::format("{}{}\n", text.empty() ? "" : "\n", what);
        for (const Field& f : table) text += line_of(f);
    }
    return text;
}

void tell_field(const Field& f, const std::string& before, std::string& text) {
    text += line_of(f);
    if (!f.symbol.empty()) text += before + "symbol   " + f.symbol + "\n";
    text += before + "default  " + fallback_of(f) + "\n";
    if (f.range || !f.choices.empty())
        text += before + (f.range ? "range    " : "one of   ") + range_of(f) + "\n";
    for (const Field& part : f.fields) text += "  " + f.name + "." + line_of(part).substr(2);
}

/// What each table says of a name.
std::string text_of_field(const std::string& name) {
    std::string text;
    FieldTable all;
    for (const auto& [what, table] : tables()) {
        all.insert(all.end(), table.begin(), table.end());
        const Field* const field = api::find(table, name);
        if (!field) continue;
        text += fmt::format("{}{}\n", text.empty() ? "" : "\n", what);
        tell_field(*field, std::string(4, ' '), text);
    }
    if (text.empty()) refuse_name("field", name, api::nearest_name(all, name));
    return text;
}

}  // namespace

Command add_parameters(CLI::App& app) {
    const auto listing = std::make_shared<Listing>();
    CLI::App* command = app.add_subcommand("parameters", "the fields of requests");
    add_listing(*command, *listing, "one of them alone, with its default and range");
    return with_exit_codes(
        command,
        [listing] {
            if (listing->is_json()) print(api::json_text(api::describe_fields()) + "\n");
            else print(listing->name.empty() ? all_fields() : text_of_field(listing->name));
            return static_cast<int>(complete);
        },
        "vines parameters\nvines parameters b\nvines parameters --format json | jq "
        "'.fields[].name'");
}

}  // namespace vines::cli
