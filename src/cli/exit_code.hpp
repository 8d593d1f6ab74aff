// Exit codes of the commands.
#pragma once

#include <functional>
#include <string>

#include "program/subcommand.hpp"

namespace vines::cli {

/// Other codes: 1 for an exception (a file cannot be read or written, or files do not fit
/// together), 130 after Ctrl-C, and 128 + the signal's number if no result can be kept.
enum ExitCode : int {
    complete = 0,
    differs = 1,    ///< vines verify: the answer differs
    refused = 2,    ///< invalid request; a problem document on stderr gives the reason
    incomplete = 3  ///< stopped by SIGTERM, or points are missing; the output so far is usable
};

/// Completes a command: signals end it, an api::Problem becomes exit code 2, and its help shows the
/// examples (one per line) and the exit codes.
Command with_exit_codes(CLI::App* app, std::function<int()> run, const std::string& examples);

}  // namespace vines::cli
