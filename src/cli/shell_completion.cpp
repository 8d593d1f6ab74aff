// Completion in bash, zsh and fish. `vines completion SHELL` prints a short function of the shell,
// which passes the words of an unfinished command line to `vines complete -- WORD...` at each Tab.
// That prints what can follow: words, or that the shell should complete the name of a file.

#include <algorithm>
#include <memory>

#include "cli/exit.hpp"
#include "cli/usage.hpp"
#include "program/process.hpp"
#include "program/subcommand.hpp"

namespace vines::cli {

namespace {

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

// The file is found in the fpath, or read by `source`.
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

/// Candidates, one per line: "word\tdescription", or "/file" or "/directory" alone.
class Candidates {
public:
    /// Only words that begin with `typed` are candidates.
    explicit Candidates(std::string typed) : typed_(std::move(typed)) {}

    void add(const std::string& word, const std::string& description = "") {
        if (!word.starts_with(typed_)) return;
        text_ += word + (description.empty() ? "" : "\t" + description) + "\n";
    }
    void add_flags(const CLI::App& command) {
        for (const CLI::Option* flag : flags_of(command))
            for (const std::string& name : names_of(*flag)) add(name, flag->get_description());
    }
    /// Values of an option or a positional; `before`: what precedes them in the same word.
    void add_values(const CLI::Option& option, const std::string& before = "") {
        const ValueUsage value = value_of(option);
        if (value.word == "file") text_ = "/file\n";
        if (value.word == "folder") text_ = "/directory\n";
        for (const std::string& choice : value.choices) add(before + choice);
    }
    const std::string& text() const { return text_; }

private:
    const std::string typed_;
    std::string text_;
};

/// Candidates for the last word.
std::string candidates(const CLI::App& app, std::vector<std::string> words) {
    // bash passes --flag=value as three words.
    if (words.back() == "=") words.back().clear();
    std::erase(words, "=");
    const std::string& word = words.back();
    Candidates found(word);
    if (words.size() == 1) {
        for (const CLI::App* c : subcommands_of(app))
            found.add(c->get_name(), c->get_description());
        if (word.starts_with('-')) found.add_flags(app);
        return found.text();
    }
    const auto commands = subcommands_of(app);
    const auto at = std::ranges::find(commands, words[0], [](auto* c) { return c->get_name(); });
    if (at == commands.end()) return "";
    const CLI::App& command = **at;
    const std::size_t equals = word.find('=');
    const std::string before = word.substr(0, equals == std::string::npos ? 0 : equals + 1);
    const std::string name = before.empty() ? words[words.size() - 2] : word.substr(0, equals);
    const CLI::Option* const flag =
        name.starts_with('-') ? command.get_option_no_throw(name) : nullptr;
    if (flag && takes_value(*flag)) {
        found.add_values(*flag, before);
        return found.text();
    }
    const auto positionals = positionals_of(command);
    if (!word.starts_with('-') && !positionals.empty()) found.add_values(*positionals[0]);
    if (found.text().empty()) found.add_flags(command);
    return found.text();
}

}  // namespace

int complete_words(const CLI::App& app, const std::vector<std::string>& words) {
    if (!words.empty()) print(candidates(app, words));
    return complete;
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
    return ended_by_signals({command, [shell] {
                                 print(
                                     *shell == "bash"  ? bash_function
                                     : *shell == "zsh" ? zsh_function
                                                       : fish_function);
                                 return 0;
                             }});
}

}  // namespace vines::cli
