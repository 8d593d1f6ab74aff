// What completes the program's words in a shell: subcommands, flags, values from a fixed set,
// files.
#pragma once

#include <string>

#include "cli/usage.hpp"

namespace vines::cli {

/// A script for bash 4.4 or newer; it needs nothing of the package bash-completion.
std::string bash_completion(const ProgramUsage& usage);

/// A function for zsh's completion system, from a file `_vines` of its fpath or by `source`.
std::string zsh_completion(const ProgramUsage& usage);

/// A file for fish.
std::string fish_completion(const ProgramUsage& usage);

}  // namespace vines::cli
