// The subcommands that need no server: the same JSON as over HTTP, from a file or stdin to a file
// or stdout.
#pragma once

#include "program/command.hpp"

namespace vines::cli {

Command add_simulate(CLI::App& app);
Command add_manifold(CLI::App& app);

/// The input is JSON if it begins with "{", else CSV, for which flags hold the fields.
Command add_identify(CLI::App& app);

/// Shards, and files that are completed where a run was stopped.
Command add_sweep(CLI::App& app);

/// Puts the files of all shards together: byte for byte the file of the whole sweep.
Command add_merge(CLI::App& app);

/// Recomputes an answer and compares.
Command add_verify(CLI::App& app);

/// Draws an answer.
Command add_plot(CLI::App& app);

/// What can be asked for.
Command add_presets(CLI::App& app);
Command add_parameters(CLI::App& app);

/// Writes something to begin with.
Command add_example(CLI::App& app);

/// Writes the OpenAPI document.
Command add_openapi(CLI::App& app);

/// Writes what completes the program's words in a shell; of the subcommands that `app` has when it
/// runs.
Command add_completion(CLI::App& app);

/// Writes the manual page; of the same.
Command add_manual(CLI::App& app);

}  // namespace vines::cli
