#include <fmt/format.h>

#include "cli/completions.hpp"

namespace vines::cli {

namespace {

/// With a backslash before each of these characters.
std::string zsh_escaped(const std::string& text, const std::string& special) {
    std::string result;
    for (const char c : text) {
        if (c == '\\' || special.find(c) != std::string::npos) result += '\\';
        result += c;
    }
    return result;
}

/// What _arguments does for a value.
std::string zsh_action(const FlagUsage& flag) {
    switch (flag.value) {
        case ValueKind::none: return "";
        case ValueKind::text: return ":value: ";
        case ValueKind::file: return ":file:_files";
        case ValueKind::folder: return ":folder:_files -/";
        case ValueKind::choice: break;
    }
    return fmt::format(":value:({})", fmt::join(flag.choices, " "));
}

/// A specification for each name of a flag: one of them keeps the others from being offered.
std::string specifications(const FlagUsage& flag) {
    const std::string others = flag.repeats ? "*" : fmt::format("({})", fmt::join(flag.names, " "));
    std::string text;
    for (const std::string& name : flag.names) {
        const bool is_long = name.starts_with("--");
        const char* follows = flag.value == ValueKind::none ? "" : is_long ? "=" : "+";
        text +=
            " \\\n                " + shell_quoted(fmt::format(
                                          "{}{}{}[{}]{}", others, name, follows,
                                          zsh_escaped(flag.description, "[]"), zsh_action(flag)));
    }
    return text;
}

std::string specification_of_positional(const FlagUsage& flag) {
    const std::string what = flag.value == ValueKind::text ? ": " : zsh_action(flag).substr(1);
    const std::string kind = what.substr(what.find(':'));
    return " \\\n                " +
           shell_quoted(fmt::format(
               "{}:{}{}", flag.repeats ? "*" : "", zsh_escaped(flag.names[0], ":"), kind));
}

std::string zsh_arguments(const CommandUsage& command) {
    std::string text = "            _arguments -s";
    for (const FlagUsage& flag : command.flags) text += specifications(flag);
    for (const FlagUsage& flag : command.positionals) text += specification_of_positional(flag);
    return text + "\n";
}

constexpr const char* zsh_script = R"(#compdef {0}
# Completion of {0} in zsh: `{0} completion zsh`.
_{0}() {{
    local -a commands=(
{1}    )
    if ((CURRENT == 2)) && [[ $words[2] != -* ]]; then
        _describe subcommand commands
        return
    fi
    local command=$words[2]
    if [[ $command != -* ]]; then
        shift words
        ((CURRENT--))
    fi
    case $command in
{2}    esac
}}
# Found in the fpath, or read by `source`.
if [[ $funcstack[1] == _{0} ]]; then
    _{0} "$@"
else
    compdef _{0} {0}
fi
)";

}  // namespace

std::string zsh_completion(const ProgramUsage& usage) {
    std::string commands;
    std::string cases =
        fmt::format("        -*)\n{}            ;;\n", zsh_arguments(usage.program));
    for (const CommandUsage& command : usage.commands) {
        const std::string entry = command.name + ":" + zsh_escaped(command.description, "");
        commands += "        " + shell_quoted(entry) + "\n";
        cases +=
            fmt::format("        {})\n{}            ;;\n", command.name, zsh_arguments(command));
    }
    return fmt::format(fmt::runtime(zsh_script), usage.program.name, commands, cases);
}

}  // namespace vines::cli
