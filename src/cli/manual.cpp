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
    return CLI::detail::find_and_replace(roff(text), "\n", "\n.br\n");
}

/// Entry in the option list of a command.
std::string entry(const CLI::Option& option) {
    std::vector<std::string> names;
    for (const std::string& name : names_of(option))
        names.push_back(option.get_positional() ? italic(name) : bold(name));
    std::string head = fmt::format("{}", fmt::join(names, ", ")),
                text = sentence(option.get_description());
    if (takes_value(option)) {
        const ValueUsage value = value_of(option);
        if (!option.get_positional()) head += " " + italic(value.word);
        if (!value.choices.empty())
            text += fmt::format(" One of: {}.", fmt::join(value.choices, ", "));
        if (!value.range.empty()) text += " Range: " + value.range + ".";
        if (!option.get_default_str().empty())
            text += " Default: " + option.get_default_str() + ".";
    }
    if (!option.get_envname().empty()) text += " Environment: " + option.get_envname() + ".";
    return fmt::format(".TP\n{}\n{}\n", head, lines_kept(text));
}

std::string entries(const CLI::App& command) {
    std::string text;
    for (const CLI::Option* option : positionals_of(command)) text += entry(*option);
    for (const CLI::Option* option : flags_of(command)) text += entry(*option);
    return text;
}

/// Synopsis of a subcommand: "sweep [flags] [request]".
std::string call_of(const CLI::App& command) {
    std::string text = bold(command.get_name()) + " [" + italic("flags") + "]";
    for (const CLI::Option* option : positionals_of(command)) {
        const bool repeats = option->get_items_expected_max() > 1;
        const std::string word = italic(option->get_name(true)) + (repeats ? " ..." : "");
        text += option->get_required() ? " " + word : " [" + word + "]";
    }
    return text;
}

std::string section_of_commands(const CLI::App& app) {
    std::string text = ".SH SUBCOMMANDS\n";
    for (const CLI::App* command : subcommands_of(app))
        text += fmt::format(
            ".SS {}\n{}\n{}", call_of(*command), lines_kept(sentence(command->get_description())),
            entries(*command));
    return text;
}

std::string section_of_variables(const CLI::App& app) {
    std::map<std::string, std::vector<std::string>> variables;
    for (const CLI::App* command : subcommands_of(app))
        for (const CLI::Option* flag : flags_of(*command))
            if (!flag->get_envname().empty())
                variables[flag->get_envname()].push_back(
                    command->get_name() + " " + names_of(*flag).back());
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
std::string section_of_notes(const CLI::App& app) {
    std::vector<std::pair<std::string, std::vector<std::string>>> notes;
    for (const CLI::App* command : subcommands_of(app))
        for (const std::string& paragraph : paragraphs_of(command->get_footer())) {
            auto same = std::ranges::find(notes, paragraph, [](const auto& n) { return n.first; });
            if (same == notes.end()) same = notes.insert(same, {paragraph, {}});
            same->second.push_back(command->get_name());
        }
    std::string text = ".SH NOTES\n";
    for (const auto& [note, names] : notes)
        text += fmt::format(
            ".TP\n{}\n{}\n", bold(fmt::format("{}", fmt::join(names, ", "))), lines_kept(note));
    return text;
}

std::string manual_page(const CLI::App& app) {
    const std::string& name = app.get_name();
    std::string summary = app.get_description();
    if (summary.ends_with('.')) summary.pop_back();
    return fmt::format(
               ".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n.nh\n.ad l\n"
               ".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{} {} [{}]\n.SH FLAGS\n",
               capitals(name), name, api::version(), name, roff(summary), bold(name),
               italic("subcommand"), italic("flags")) +
           entries(app) + section_of_commands(app) + section_of_variables(app) +
           section_of_notes(app);
}

}  // namespace

Command add_manual(CLI::App& app) {
    CLI::App* command = app.add_subcommand("manual", "the manual page");
    add_examples(*command, "vines manual | man -l -");
    return ended_by_signals({command, [&app] {
                                 print(manual_page(app));
                                 return 0;
                             }});
}

}  // namespace vines::cli
