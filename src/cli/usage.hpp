// What CLI11's table says of the program: read once, written as completions and as the manual.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace vines::cli {

/// What stands behind a flag.
enum class ValueKind { none, text, file, folder, choice };

/// A flag with all of its names, or a positional with its one.
struct FlagUsage {
    std::vector<std::string> names;    ///< as they are typed: -o, --output
    std::string description;           ///< without a full stop
    std::string environment;           ///< the variable that stands for it
    std::string standard;              ///< the default
    std::string range;                 ///< "0 to 65535"
    std::vector<std::string> choices;  ///< of ValueKind::choice
    ValueKind value = ValueKind::text;
    bool required = false, repeats = false;
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

/// Of a program whose subcommands are all registered.
ProgramUsage usage_of(const CLI::App& app);

/// The word for a value in a text that has no list of them; empty: there is no value.
std::string value_word(const FlagUsage& flag);

/// In single quotes, as sh, bash and zsh take a word.
std::string shell_quoted(const std::string& text);

}  // namespace vines::cli
