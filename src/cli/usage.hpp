// The program's subcommands and options, read from CLI11 for completions and the manual page.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vines::cli {

/// Subcommands in the order of --help.
inline std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

inline std::vector<const CLI::Option*> positionals_of(const CLI::App& command) {
    return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}
/// Options that are no positionals.
inline std::vector<const CLI::Option*> flags_of(const CLI::App& command) {
    return command.get_options([](const CLI::Option* option) { return !option->get_positional(); });
}

/// Names as typed (-o, --output), or the name of a positional.
inline std::vector<std::string> names_of(const CLI::Option& option) {
    return CLI::detail::split(option.get_name(false, true), ',');
}

inline bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// Value of an option or a positional.
struct ValueUsage {
    std::string word = "value";  ///< placeholder: value, file or folder
    std::string range{};         ///< "0 to 65535"
    std::vector<std::string> choices{};
};

/// Reads the type as CLI11 writes it: TEXT:{json,text}, INT:[0 - 65535], TEXT:DIR, FILE.
inline ValueUsage value_of(const CLI::Option& option) {
    ValueUsage value;
    for (const std::string& part : CLI::detail::split(option.get_type_name(), ':')) {
        const auto inner = [&part] { return part.substr(1, part.size() - 2); };
        if (part == "FILE") value.word = "file";
        if (part == "DIR") value.word = "folder";
        if (part.starts_with('['))
            value.range = CLI::detail::find_and_replace(inner(), " - ", " to ");
        if (part.starts_with('{')) value.choices = CLI::detail::split(inner(), ',');
    }
    return value;
}

}  // namespace vines::cli
