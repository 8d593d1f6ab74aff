// The program's subcommands and options, read from CLI11 for completions and the manual page.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vines::cli {

/// Kind of value after an option.
enum class ValueKind { none, text, file, folder, choice };

/// An option with all its names, or a positional with one.
struct FlagUsage {
    std::vector<std::string> names;    ///< as typed: -o, --output
    std::string description;           ///< without a full stop
    std::string environment;           ///< environment variable that sets it
    std::string default_value;         ///< default
    std::string range;                 ///< "0 to 65535"
    std::vector<std::string> choices;  ///< for ValueKind::choice
    ValueKind value = ValueKind::text;
    bool required = false, repeats = false;

    /// Placeholder for the value of an option; empty if it takes none.
    const char* value_word() const {
        switch (value) {
            case ValueKind::none: return "";
            case ValueKind::file: return "file";
            case ValueKind::folder: return "folder";
            case ValueKind::choice:
            case ValueKind::text: break;
        }
        return "value";
    }
};

/// A subcommand, or the program itself.
struct CommandUsage {
    std::string name, description, footer;
    std::vector<FlagUsage> flags, positionals;
};

struct ProgramUsage {
    CommandUsage program;
    std::vector<CommandUsage> commands;  ///< in the order of --help
};

/// Call it after all subcommands are registered.
ProgramUsage usage_of(const CLI::App& app);

}  // namespace vines::cli
