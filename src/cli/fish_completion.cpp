#include <fmt/format.h>

#include "cli/completions.hpp"

namespace vines::cli {

namespace {

/// In single quotes, in which fish has a backslash for a quote and for itself.
std::string fish_quoted(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) {
        if (c == '\'' || c == '\\') quoted += '\\';
        quoted += c;
    }
    return quoted + "'";
}

/// What may stand behind a flag, or as a positional.
std::string fish_values(const FlagUsage& flag) {
    switch (flag.value) {
        case ValueKind::none: return "";
        case ValueKind::text: return " -x";
        case ValueKind::file: return " -r -F";
        case ValueKind::folder: return " -x -a '(__fish_complete_directories)'";
        case ValueKind::choice: break;
    }
    return " -x -a " + fish_quoted(fmt::format("{}", fmt::join(flag.choices, " ")));
}

std::string fish_names(const FlagUsage& flag) {
    std::string text;
    for (const std::string& name : flag.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    return text;
}

/// A line for each flag, and one for the positionals.
std::string fish_lines(const CommandUsage& command, const std::string& begin) {
    std::string text;
    for (const FlagUsage& flag : command.flags)
        text += begin + fish_names(flag) + fish_values(flag) + " -d " +
                fish_quoted(flag.description) + "\n";
    for (const FlagUsage& flag : command.positionals)
        if (flag.value == ValueKind::file) text += begin + " -F\n";
        else if (flag.value != ValueKind::text) text += begin + fish_values(flag) + "\n";
    return text;
}

constexpr const char* fish_head = R"(# Completion of {0} in fish: `{0} completion fish`.
function __{0}_asked -d 'whether the first word is this subcommand; without one, whether there is none yet'
    set -l words (commandline -opc)
    test "$words[2]" = "$argv[1]"
end
complete -c {0} -f
)";

}  // namespace

std::string fish_completion(const ProgramUsage& usage) {
    const std::string& program = usage.program.name;
    const auto begin = [&program](const std::string& command) {
        return fmt::format(
            "complete -c {0} -n '__{0}_asked{1}'", program, command.empty() ? "" : " " + command);
    };
    std::string text = fmt::format(fmt::runtime(fish_head), program);
    text += fish_lines(usage.program, begin(""));
    for (const CommandUsage& command : usage.commands) {
        text += fmt::format(
            "{} -a {} -d {}\n", begin(""), command.name, fish_quoted(command.description));
        text += fish_lines(command, begin(command.name));
    }
    return text;
}

}  // namespace vines::cli
