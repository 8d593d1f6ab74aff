#include <fmt/format.h>

#include <algorithm>

#include "cli/completions.hpp"

namespace vines::cli {

namespace {

std::vector<std::string> all_names(const std::vector<FlagUsage>& flags) {
    std::vector<std::string> names;
    for (const FlagUsage& flag : flags)
        names.insert(names.end(), flag.names.begin(), flag.names.end());
    return names;
}

/// What is set for a word of this kind; empty: nothing is known of it.
std::string bash_assignment(const FlagUsage& flag) {
    switch (flag.value) {
        case ValueKind::file: return "path=file";
        case ValueKind::folder: return "path=directory";
        case ValueKind::choice:
            return "words=" + shell_quoted(fmt::format("{}", fmt::join(flag.choices, " ")));
        case ValueKind::none:
        case ValueKind::text: break;
    }
    return "";
}

/// The branches for words that stand behind a flag.
std::string branches_of_values(const CommandUsage& command) {
    std::string text;
    for (const FlagUsage& flag : command.flags) {
        if (flag.value == ValueKind::none) continue;
        std::vector<std::string> patterns;
        for (const std::string& name : flag.names)
            patterns.push_back(shell_quoted(command.name + " " + name));
        const std::string known = bash_assignment(flag);
        text += fmt::format(
            "        {}) {} ;;\n", fmt::join(patterns, " | "), known.empty() ? "return" : known);
    }
    return text;
}

/// The branch for the other words of a subcommand.
std::string branch_of_words(const CommandUsage& command) {
    std::string text = fmt::format(
        "        {}' '*) flags={}", command.name,
        shell_quoted(fmt::format("{}", fmt::join(all_names(command.flags), " "))));
    if (!command.positionals.empty())
        if (const std::string known = bash_assignment(command.positionals[0]); !known.empty())
            text += " " + known;
    return text + " ;;\n";
}

constexpr const char* before_branches = R"(_{0}() {{
    local word=${{COMP_WORDS[COMP_CWORD]}} before=${{COMP_WORDS[COMP_CWORD - 1]}}
    local command=${{COMP_WORDS[1]}} flags='' words='' path=''
    COMPREPLY=()
    # --flag=value comes as three words.
    if [[ $word == = ]]; then
        word=''
    elif [[ $before == = ]]; then
        before=${{COMP_WORDS[COMP_CWORD - 2]}}
    fi
    [[ $COMP_CWORD -gt 1 ]] || command='' before=''
    case "$command $before" in
)";

constexpr const char* behind_branches = R"(        *) return ;;
    esac
    if [[ $flags && ($word == -* || -z $words$path) ]]; then
        words=$flags path=''
    fi
    if [[ $path ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -A $path -- "$word")
    else
        mapfile -t COMPREPLY < <(compgen -W "$words" -- "$word")
    fi
}}
complete -F _{0} {0}
)";

}  // namespace

std::string bash_completion(const ProgramUsage& usage) {
    const std::string& program = usage.program.name;
    // The first word is a subcommand, or a flag of the program.
    CommandUsage first = usage.program;
    first.name = "";
    FlagUsage subcommand;
    subcommand.value = ValueKind::choice;
    for (const CommandUsage& command : usage.commands) subcommand.choices.push_back(command.name);
    first.positionals = {subcommand};
    std::string text =
        fmt::format("# Completion of {0} in bash: `{0} completion bash`.\n", program);
    text += fmt::format(fmt::runtime(before_branches), program);
    text += branch_of_words(first);
    for (const CommandUsage& command : usage.commands)
        text += branches_of_values(command) + branch_of_words(command);
    return text + fmt::format(fmt::runtime(behind_branches), program);
}

}  // namespace vines::cli
