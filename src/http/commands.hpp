// The subcommands serve and healthcheck.
#pragma once

#include "program/command.hpp"

namespace vines::http {

/// Serves until SIGTERM or SIGINT, then exit code 0.
Command add_serve(CLI::App& app);

/// Exit code 0 if a running service says that it is well, else 1.
Command add_healthcheck(CLI::App& app);

}  // namespace vines::http
