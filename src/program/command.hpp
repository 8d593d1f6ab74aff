// A subcommand of the program.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace vines {

/// Its flags are registered with `app`. Once they are parsed, run() does its work and returns the
/// exit code. What it throws is told on stderr, with exit code 1.
struct Command {
    CLI::App* app;
    std::function<int()> run;
};

}  // namespace vines
