// `vines presets`: the paper's figures and tables as requests.
#include "api/presets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "api/json_text.hpp"
#include "api/schema/nearest_name.hpp"
#include "cli/commands.hpp"
#include "cli/exit_code.hpp"
#include "cli/listing.hpp"
#include "program/print.hpp"

namespace vines::cli {

namespace {

std::string all_presets() {
    std::size_t name = 0, source = 0;
    for (const api::Preset& p : api::presets()) {
        name = std::max(name, p.name.size());
        source = std::max(source, p.source.size());
    }
    std::string text;
    for (const api::Preset& p : api::presets())
        text += fmt::format("{:<{}}  {:<{}}  {}\n", p.name, name, p.source, source, p.title);
    return text;
}

std::string text_of(const api::Preset& p) {
    std::string text = fmt::format("{}, {}: {}\n", p.name, p.source, p.title);
    if (!p.note.empty()) text += p.note + "\n";
    for (const auto& [name, value] : p.parameters.items())
        text += fmt::format("  {} = {}\n", name, api::json_text(value));
    return text + fmt::format("vines simulate -p preset={} --plot\n", p.name);
}

std::string text_of_preset(const std::string& name) {
    std::vector<std::string> names;
    for (const api::Preset& p : api::presets()) {
        if (p.name == name) return text_of(p);
        names.push_back(p.name);
    }
    refuse_name("preset", name, api::nearest_name(names, name));
}

}  // namespace

Command add_presets(CLI::App& app) {
    const auto listing = std::make_shared<Listing>();
    CLI::App* command =
        app.add_subcommand("presets", "the paper's figures and tables, as requests");
    add_listing(*command, *listing, "one of them alone, with its parameters");
    return with_exit_codes(
        command,
        [listing] {
            if (listing->is_json()) print(api::json_text(api::describe_presets()) + "\n");
            else print(listing->name.empty() ? all_presets() : text_of_preset(listing->name));
            return static_cast<int>(complete);
        },
        "vines presets\nvines presets fig3\nvines presets --format json | jq length");
}

}  // namespace vines::cli
