// `vines completion` and `manual`, from the subcommands and options as CLI11 knows them.
//
// `vines completion SHELL` prints a short function of the shell, which passes the words of an
// unfinished command line to `vines complete -- WORD...` at each Tab. That prints what can follow:
// words, or /file or /directory, for which the shell completes a name. `vines manual` prints roff.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <memory>
#include <utility>

#include "api/version.hpp"
#include "cli/exit.hpp"
#include "program/process.hpp"
#include "program/subcommand.hpp"

namespace vines::cli {

namespace {

/// Subcommands in the order of --help.
std::vector<const CLI::App*> subcommands_of(const CLI::App& app) {
    return app.get_subcommands([](const CLI::App*) { return true; });
}

std::vector<const CLI::Option*> positionals_of(const CLI::App& command) {
    return command.get_options([](const CLI::Option* option) { return option->get_positional(); });
}
/// Options with dashes, which the help calls flags, with or without a value.
std::vector<const CLI::Option*> flags_of(const CLI::App& command) {
    return command.get_options([](const CLI::Option* option) { return !option->get_positional(); });
}

/// Names as typed (-o, --output), or the name of a positional.
std::vector<std::string> names_of(const CLI::Option& option) {
    return CLI::detail::split(option.get_name(false, true), ',');
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// Value of an option or a positional.
struct ValueUsage {
    std::string word = "value";  ///< placeholder: value, file or folder
    std::string range{};         ///< "0 to 65535"
    std::vector<std::string> choices{};
};

/// Reads the type as CLI11 writes it: TEXT:{json,text}, INT:[0 - 65535], TEXT:DIR, FILE.
ValueUsage value_of(const CLI::Option& option) {
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

// --- Completion ---

constexpr const char* bash_function = R"(_vines() {
    local word=${COMP_WORDS[COMP_CWORD]}
    mapfile -t COMPREPLY < <(vines complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null)
    if [[ $COMPREPLY == /* ]]; then
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(compgen -A "${COMPREPLY#/}" -- "${word#=}")
    fi
    COMPREPLY=("${COMPREPLY[@]%%$'\t'*}")
}
complete -F _vines vines
)";

// Works as a file in the fpath, where it is called _vines, and with `source`.
constexpr const char* zsh_function = R"(#compdef vines
_vines() {
    local -a found=("${(@f)$(command vines complete -- "${(@)words[2,CURRENT]}" 2>/dev/null)}")
    case $found[1] in
        /file) compset -P '--*='; _files ;;
        /directory) compset -P '--*='; _files -/ ;;
        ?*) found=("${(@)found/$'\t'/:}"); _describe vines found ;;
    esac
}
if [[ $funcstack[1] == _vines ]]; then
    _vines "$@"
else
    compdef _vines vines
fi
)";

constexpr const char* fish_function = R"(function __vines_complete
    set -l word (commandline -ct)
    set -l words (commandline -opc) $word
    set -l found (vines complete -- $words[2..] 2>/dev/null)
    set -l flag (string match -r -- '^--[^=]*=' $word)
    switch "$found[1]"
        case /file
            printf '%s\n' "$flag"(__fish_complete_path (string replace -- "$flag" '' $word))
        case /directory
            printf '%s\n' "$flag"(__fish_complete_directories (string replace -- "$flag" '' $word))
        case '*'
            string join \n -- $found
    end
end
complete -c vines -f -a '(__vines_complete)'
)";

/// The line of a candidate, "word\tdescription", if it begins with what is typed.
std::string candidate(
    const std::string& typed, const std::string& word, const std::string& description = "") {
    if (!word.starts_with(typed)) return "";
    return word + (description.empty() ? "" : "\t" + description) + "\n";
}

std::string candidate_flags(const std::string& typed, const CLI::App& command) {
    std::string lines;
    for (const CLI::Option* flag : flags_of(command))
        for (const std::string& name : names_of(*flag))
            lines += candidate(typed, name, flag->get_description());
    return lines;
}

/// Values of an option or a positional; `before`: what precedes them in the same word. "/file" or
/// "/directory" alone: the shell completes the name.
std::string candidate_values(
    const std::string& typed, const CLI::Option& option, const std::string& before = "") {
    const ValueUsage value = value_of(option);
    if (value.word == "file") return "/file\n";
    if (value.word == "folder") return "/directory\n";
    std::string lines;
    for (const std::string& choice : value.choices) lines += candidate(typed, before + choice);
    return lines;
}

/// Candidates for the last word, one per line.
std::string candidates(const CLI::App& app, std::vector<std::string> words) {
    // bash passes --flag=value as three words, other shells as one.
    if (words.back() == "=") words.back().clear();
    std::erase(words, "=");
    const std::string& word = words.back();
    const auto commands = subcommands_of(app);
    std::string found;
    if (words.size() == 1) {
        for (const CLI::App* c : commands)
            found += candidate(word, c->get_name(), c->get_description());
        return word.starts_with('-') ? found + candidate_flags(word, app) : found;
    }
    const auto at = std::ranges::find(commands, words[0], [](auto* c) { return c->get_name(); });
    if (at == commands.end()) return "";
    const CLI::App& command = **at;
    const std::size_t equals = word.find('=');
    const std::string before = word.substr(0, equals == std::string::npos ? 0 : equals + 1);
    const std::string name = before.empty() ? words[words.size() - 2] : word.substr(0, equals);
    const CLI::Option* const flag =
        name.starts_with('-') ? command.get_option_no_throw(name) : nullptr;
    if (flag && takes_value(*flag)) return candidate_values(word, *flag, before);
    const auto positionals = positionals_of(command);
    if (!word.starts_with('-') && !positionals.empty())
        found = candidate_values(word, *positionals[0]);
    return found.empty() ? candidate_flags(word, command) : found;
}

// --- The manual page ---

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

std::string sentence(std::string text) {
    if (text.empty()) return text;
    text[0] = capital(text[0]);
    return text + (text.ends_with('.') ? "" : ".");
}

/// Escaped for roff, with its line breaks.
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
    std::string title = name, summary = app.get_description();
    std::ranges::transform(title, title.begin(), capital);
    if (summary.ends_with('.')) summary.pop_back();
    return fmt::format(
               ".TH {} 1 \"\" \"{} {}\" \"User Commands\"\n.nh\n.ad l\n"
               ".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{} {} [{}]\n.SH FLAGS\n",
               title, name, api::version(), name, roff(summary), bold(name), italic("subcommand"),
               italic("flags")) +
           entries(app) + section_of_commands(app) + section_of_variables(app) +
           section_of_notes(app);
}

}  // namespace

int complete_words(const CLI::App& app, const std::vector<std::string>& words) {
    if (!words.empty()) print(candidates(app, words));
    return 0;
}

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
    const auto run = [shell] {
        print(*shell == "bash" ? bash_function : *shell == "zsh" ? zsh_function : fish_function);
        return 0;
    };
    return ended_by_signals({command, run});
}

Command add_manual(CLI::App& app) {
    CLI::App* command = app.add_subcommand("manual", "the manual page");
    add_examples(*command, "vines manual | man -l -");
    return ended_by_signals({command, [&app] {
                                 print(manual_page(app));
                                 return 0;
                             }});
}

}  // namespace vines::cli
