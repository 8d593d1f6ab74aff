// The subcommand reproduce.
#pragma once

#include "program/command.hpp"

namespace vines::report {

/// Exit code 0 if every number lies in its band, else 1.
Command add_reproduce(CLI::App& app);

}  // namespace vines::report
