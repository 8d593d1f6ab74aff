// `vines completion`: a script that completes subcommands, options, values from a fixed set, and
// files in bash, zsh or fish. All three are written from the usage that CLI11 knows (usage.hpp).
#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/exit.hpp"
#include "cli/usage.hpp"
#include "program/process.hpp"
#include "program/subcommand.hpp"

namespace vines::cli {

namespace {

/// Escapes these characters and backslashes by a backslash.
std::string escaped(const std::string& text, const std::string& special) {
    std::string result;
    for (const char c : text) {
        if (c == '\\' || special.find(c) != std::string::npos) result += '\\';
        result += c;
    }
    return result;
}

/// In single quotes, valid in sh, bash and zsh.
std::string shell_quoted(const std::string& text) {
    std::string quoted = "'";
    for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

/// Assignment for a value of this kind in the script; empty: nothing to complete.
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

/// Branches for words that follow an option.
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

/// Branch for the other words of a subcommand.
std::string branch_of_words(const CommandUsage& command) {
    std::vector<std::string> names;
    for (const FlagUsage& flag : command.flags)
        names.insert(names.end(), flag.names.begin(), flag.names.end());
    std::string text = fmt::format(
        "        {}' '*) flags={}", command.name,
        shell_quoted(fmt::format("{}", fmt::join(names, " "))));
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

constexpr const char* after_branches = R"(        *) return ;;
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

/// Script for bash 4.4 or newer. It does not need the package bash-completion.
std::string bash_completion(const ProgramUsage& usage) {
    const std::string& program = usage.program.name;
    // The first word is a subcommand or an option of the program.
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
    return text + fmt::format(fmt::runtime(after_branches), program);
}

/// Value of an option or a positional in a specification of _arguments.
std::string zsh_value(const FlagUsage& flag, const std::string& word) {
    switch (flag.value) {
        case ValueKind::none: return "";
        case ValueKind::text: return ":" + word + ": ";
        case ValueKind::file: return ":" + word + ":_files";
        case ValueKind::folder: return ":" + word + ":_files -/";
        case ValueKind::choice: break;
    }
    return fmt::format(":{}:({})", word, fmt::join(flag.choices, " "));
}

std::string zsh_argument(const std::string& specification) {
    return " \\\n                " + shell_quoted(specification);
}

/// A specification for each name of an option: after one of them the others are not offered.
std::string zsh_flag(const FlagUsage& flag) {
    const std::string others = flag.repeats ? "*" : fmt::format("({})", fmt::join(flag.names, " "));
    std::string text;
    for (const std::string& name : flag.names) {
        const bool is_long = name.starts_with("--");
        const char* follows = flag.value == ValueKind::none ? "" : is_long ? "=" : "+";
        text += zsh_argument(fmt::format(
            "{}{}{}[{}]{}", others, name, follows, escaped(flag.description, "[]"),
            zsh_value(flag, flag.value_word())));
    }
    return text;
}

std::string zsh_arguments(const CommandUsage& command) {
    std::string text = "            _arguments -s";
    for (const FlagUsage& flag : command.flags) text += zsh_flag(flag);
    for (const FlagUsage& flag : command.positionals)
        text +=
            zsh_argument((flag.repeats ? "*" : "") + zsh_value(flag, escaped(flag.names[0], ":")));
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

/// Function for zsh's completion system, for a file `_vines` in fpath or for `source`.
std::string zsh_completion(const ProgramUsage& usage) {
    std::string commands;
    std::string cases =
        fmt::format("        -*)\n{}            ;;\n", zsh_arguments(usage.program));
    for (const CommandUsage& command : usage.commands) {
        const std::string entry = command.name + ":" + escaped(command.description, "");
        commands += "        " + shell_quoted(entry) + "\n";
        cases +=
            fmt::format("        {})\n{}            ;;\n", command.name, zsh_arguments(command));
    }
    return fmt::format(fmt::runtime(zsh_script), usage.program.name, commands, cases);
}

/// In single quotes.
std::string fish_quoted(const std::string& text) { return "'" + escaped(text, "'") + "'"; }

/// Values of an option or a positional.
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

/// One line per option, and one for the positionals.
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
function __{0}_asked -d 'true if the first word is this subcommand, or, without an argument, if there is none yet'
    set -l words (commandline -opc)
    test "$words[2]" = "$argv[1]"
end
complete -c {0} -f
)";

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

}  // namespace

Command add_completion(CLI::App& app) {
    const auto shell = std::make_shared<std::string>();
    CLI::App* command = app.add_subcommand("completion", "shell completion for bash, zsh or fish");
    command->add_option("shell", *shell, "the shell")
        ->required()
        ->check(CLI::IsMember({"bash", "zsh", "fish"}));
    add_examples(
        *command,
        "source <(vines completion bash)    # or zsh; for the current shell only\n"
        "vines completion fish | source",
        "The Debian package installs completion for all three shells.");
    return ended_by_signals({command, [&app, shell] {
                                 const ProgramUsage usage = usage_of(app);
                                 print(
                                     *shell == "bash"  ? bash_completion(usage)
                                     : *shell == "zsh" ? zsh_completion(usage)
                                                       : fish_completion(usage));
                                 return 0;
                             }});
}

}  // namespace vines::cli
