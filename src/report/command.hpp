// Subcommand `reproduce`.
#pragma once

#include "program/subcommand.hpp"

namespace vines::report {

/// Adds the subcommand. Exit code 0 if every verdict is the expected one, else 1.
Command add_reproduce(CLI::App& app);

}  // namespace vines::report
