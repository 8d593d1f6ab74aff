// Subcommands that need no server. They read and write the same JSON as the service, from a file or
// stdin to a file or stdout.
#pragma once

#include "program/subcommand.hpp"

namespace vines::cli {

Command add_simulate(CLI::App& app);
Command add_manifold(CLI::App& app);

/// Input that begins with "{" is JSON; any other is CSV, whose request fields are given by options.
Command add_identify(CLI::App& app);

/// Computes a sweep or a shard of it, and completes the file of an interrupted run.
Command add_sweep(CLI::App& app);

/// Combines the files of all shards into the file of the whole sweep, byte for byte.
Command add_merge(CLI::App& app);

/// Recomputes an answer and compares it byte for byte.
Command add_verify(CLI::App& app);

/// Draws an answer in the terminal or as SVG.
Command add_plot(CLI::App& app);

/// Lists presets and request fields.
Command add_presets(CLI::App& app);
Command add_parameters(CLI::App& app);

/// Writes an example record.
Command add_example(CLI::App& app);

Command add_openapi(CLI::App& app);

/// Writes the completion script of a shell for the subcommands that `app` has when it runs.
Command add_completion(CLI::App& app);

/// Writes the manual page for the same subcommands.
Command add_manual(CLI::App& app);

}  // namespace vines::cli
