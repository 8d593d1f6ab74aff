// What a command ends with.
#pragma once

#include <functional>
#include <string>

#include "program/command.hpp"

namespace vines::cli {

/// Beside 1, for what a command throws: a file cannot be read or written, or files do not fit
/// together; 130 of Ctrl-C, and 128 + its number of another signal that finds nothing to be kept.
enum ExitCode : int {
    complete = 0,
    differs = 1,    ///< of verify: it is not what was answered
    refused = 2,    ///< the request is at fault: a problem document on stderr says where
    incomplete = 3  ///< stopped by SIGTERM, or points are missing: what is there is usable
};

/// A command that signals end, that is refused by an api::Problem, and whose help shows examples,
/// a line each, and the exit codes.
Command with_exit_codes(CLI::App* app, std::function<int()> run, const std::string& examples);

}  // namespace vines::cli
