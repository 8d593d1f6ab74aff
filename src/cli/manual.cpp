// `vines manual`: the manual page, in roff.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <utility>

#include "api/version.hpp"
#include "cli/exit.hpp"
#include "cli/usage.hpp"
#include "program/process.hpp"
#include "program/subcommand.hpp"

namespace vines::cli {

namespace {

/// Escapes a text for roff: minus signs stay minus signs when copied from the page, and no line is
/// read as a roff request.
std::string roff(const std::string& text) {
    std::string result;
    for (const char c : text) {
        const bool begins = result.empty() || result.back() == '\n';
        if (begins && (c == '.' || c == '\'')) result += "\\&";
        if (c == '-' || c == '\\') result += c == '-' ? "\\-" : "\\e";
        else result += c;
    }
    return result;
}

std::string bold(const std::string& text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(const std::string& text) { return "\\fI" + roff(text) + "\\fR"; }

char capital(char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); }

std::string capitals(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), capital);
    return text;
}

std::string sentence(std::string text) {
    if (text.empty()) return text;
    text[0] = capital(text[0]);
    return text + (text.ends_with('.') ? "" : ".");
}

/// Keeps line breaks.
std::string lines_kept(const std::string& text) {
    std::string result;
    for (const char c : roff(text)) {
        if (c == '\n') result += "\n.br\n";
        else result += c;
    }
    return result;
}

std::string flag_meaning(const FlagUsage& flag) {
    std::string text = sentence(flag.description);
    if (!flag.choices.empty()) text += fmt::format(" One of: {}.", fmt::join(flag.choices, ", "));
    if (!flag.range.empty()) text += " Range: " + flag.range + ".";
    if (!flag.default_value.empty()) text += " Default: " + flag.default_value + ".";
    if (!flag.environment.empty()) text += " Environment: " + flag.environment + ".";
    return lines_kept(text) + "\n";
}

/// Entry in the option list of a command.
std::string flag_entry(const FlagUsage& flag, bool positional) {
    std::vector<std::string> names;
    for (const std::string& name : flag.names)
        names.push_back(positional ? italic(name) : bold(name));
    const std::string value = positional ? "" : flag.value_word();
    return fmt::format(
        ".TP\n{}{}\n{}", fmt::join(names, ", "), value.empty() ? "" : " " + italic(value),
        flag_meaning(flag));
}

std::string flag_entries(const CommandUsage& command) {
    std::string text;
    for (const FlagUsage& flag : command.positionals) text += flag_entry(flag, true);
    for (const FlagUsage& flag : command.flags) text += flag_entry(flag, false);
    return text;
}

/// Synopsis of a subcommand: "sweep [flags] [request]".
std::string call_of(const CommandUsage& command) {
    std::string text = bold(command.name) + " [" + italic("flags") + "]";
    for (const FlagUsage& flag : command.positionals) {
        const std::string word = italic(flag.names[0]) + (flag.repeats ? " ..." : "");
        text += flag.required ? " " + word : " [" + word + "]";
    }
    return text;
}

std::string section_of_commands(const ProgramUsage& usage) {
    std::string text = ".SH SUBCOMMANDS\n";
    for (const CommandUsage& command : usage.commands)
        text += fmt::format(
            ".SS {}\n{}\n{}", call_of(command), lines_kept(sentence(command.description)),
            flag_entries(command));
    return text;
}

std::string section_of_variables(const ProgramUsage& usage) {
    std::map<std::string, std::vector<std::string>> variables;
    for (const CommandUsage& command : usage.commands)
        for (const FlagUsage& flag : command.flags)
            if (!flag.environment.empty())
                variables[flag.environment].push_back(command.name + " " + flag.names.back());
    if (variables.empty()) return "";
    std::string text =
        ".SH ENVIRONMENT\nA flag overrides its variable, which overrides the default.\n";
    for (const auto& [name, flags] : variables)
        text += fmt::format(
            ".TP\n{}\n{}\n", bold(name), roff(fmt::format("{}.", fmt::join(flags, ", "))));
    return text;
}

/// Splits a text at empty lines.
std::vector<std::string> paragraphs_of(const std::string& text) {
    std::vector<std::string> paragraphs;
    for (std::size_t from = 0; from < text.size();) {
        const std::size_t end = std::min(text.find("\n\n", from), text.size());
        paragraphs.push_back(text.substr(from, end - from));
        from = end + 2;
    }
    return paragraphs;
}

/// Notes below the help of the subcommands; a note that several of them share is printed once.
std::string section_of_notes(const ProgramUsage& usage) {
    std::vector<std::pair<std::string, std::vector<std::string>>> notes;
    for (const CommandUsage& command : usage.commands)
        for (const std::string& paragraph : paragraphs_of(command.footer)) {
            auto same = std::find_if(notes.begin(), notes.end(), [&paragraph](const auto& note) {
                return note.first == paragraph;
            });
            if (same == notes.end()) same = notes.insert(same, {paragraph, {}});
            same->second.push_back(command.name);
        }
    std::string text = notes.empty() ? "" : ".SH NOTES\n";
    for (const auto& [note, names] : notes)
        text += fmt::format(
            ".TP\n{}\n{}\n", bold(fmt::format("{}", fmt::join(names, ", "))), lines_kept(note));
    return text;
}

std::string manual_page(const ProgramUsage& usage) {
    const CommandUsage& program = usage.program;
    std::string summary = program.description;
    if (summary.ends_with('.')) summary.pop_back();
    return fmt::format(
               ".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n.nh\n.ad l\n"
               ".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{} {} [{}]\n.SH FLAGS\n",
               capitals(program.name), program.name, api::version(), program.name, roff(summary),
               bold(program.name), italic("subcommand"), italic("flags")) +
           flag_entries(program) + section_of_commands(usage) + section_of_variables(usage) +
           section_of_notes(usage);
}

}  // namespace

Command add_manual(CLI::App& app) {
    CLI::App* command = app.add_subcommand("manual", "the manual page");
    add_examples(*command, "vines manual | man -l -");
    return ended_by_signals({command, [&app] {
                                 print(manual_page(usage_of(app)));
                                 return 0;
                             }});
}

}  // namespace vines::cli
