#include "cli/usage.hpp"

namespace vines::cli {

namespace {

/// A text without its brackets.
std::string inner(const std::string& text) { return text.substr(1, text.size() - 2); }

/// "[0 - 65535]" as "0 to 65535".
std::string range_in_words(const std::string& part) {
    std::string range = inner(part);
    if (const std::size_t dash = range.find(" - "); dash != std::string::npos)
        range.replace(dash, 3, " to ");
    return range;
}

/// Reads a type as CLI11 writes it: TEXT:{json,text}, INT:[0 - 65535], TEXT:DIR, FILE.
void read_type(const std::string& type, FlagUsage& flag) {
    for (const std::string& part : CLI::detail::split(type, ':')) {
        if (part == "FILE") flag.value = ValueKind::file;
        if (part == "DIR") flag.value = ValueKind::folder;
        if (part.starts_with('[')) flag.range = range_in_words(part);
        if (part.starts_with('{')) {
            flag.value = ValueKind::choice;
            flag.choices = CLI::detail::split(inner(part), ',');
        }
    }
}

/// Everything but the names.
FlagUsage read_option(const CLI::Option& option) {
    FlagUsage flag;
    flag.description = option.get_description();
    flag.environment = option.get_envname();
    flag.required = option.get_required();
    flag.repeats = option.get_items_expected_max() > 1;
    if (option.get_items_expected_max() == 0) {
        flag.value = ValueKind::none;
        return flag;
    }
    flag.default_value = option.get_default_str();
    read_type(option.get_type_name(), flag);
    return flag;
}

CommandUsage read_command(const CLI::App& app) {
    CommandUsage command{
        .name = app.get_name(),
        .description = app.get_description(),
        .footer = app.get_footer(),
        .flags = {},
        .positionals = {}};
    for (const CLI::Option* option : app.get_options()) {
        FlagUsage flag = read_option(*option);
        if (option->get_positional()) {
            flag.names = {option->get_name(true)};
            command.positionals.push_back(flag);
            flag.names.clear();
        }
        for (const std::string& name : option->get_snames()) flag.names.push_back("-" + name);
        for (const std::string& name : option->get_lnames()) flag.names.push_back("--" + name);
        if (!flag.names.empty()) command.flags.push_back(std::move(flag));
    }
    return command;
}

}  // namespace

ProgramUsage usage_of(const CLI::App& app) {
    ProgramUsage usage{read_command(app), {}};
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
        usage.commands.push_back(read_command(*command));
    return usage;
}

}  // namespace vines::cli
