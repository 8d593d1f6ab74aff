// The subcommands serve and healthcheck.
#pragma once

#include "program/subcommand.hpp"

namespace vines::http {

/// Serves until SIGTERM or SIGINT, then exits with code 0.
Command add_serve(CLI::App& app);

/// Exits with code 0 if a running service is healthy, else 1.
Command add_healthcheck(CLI::App& app);

}  // namespace vines::http
