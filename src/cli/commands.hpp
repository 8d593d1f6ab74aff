// The subcommands that compute: the same JSON as over HTTP, from a file or stdin to a file or
// stdout.
#pragma once

#include <string>
#include <vector>

namespace vines::cli {

/// What the program ends with.
enum ExitCode : int {
    complete = 0,
    failed = 1,     ///< a file cannot be read or written, files do not fit together
    refused = 2,    ///< the request is at fault: a problem document on stderr says where
    incomplete = 3  ///< stopped by a signal, or points are missing: what is there is usable
};

/// "-" or "" stands for stdin and stdout.
struct Files {
    std::string input, output;
};

int simulate(const Files& files);
/// The input is JSON if it begins with "{", else CSV, for which `query` holds the fields as in a
/// URL.
int identify(const Files& files, const std::string& query);

struct SweepOptions {
    Files files;
    bool resume = false;  ///< complete the output file instead of refusing to overwrite it
    /// "i/N" (i from 0), "auto" (from the environment of a Slurm array or a Kubernetes Indexed
    /// Job), or "".
    std::string shard;
    int shards = 0;   ///< N for "auto" where the environment has only i
    int threads = 0;  ///< 0: the cores
};
int sweep(const SweepOptions& options);

/// Puts the files of all shards together: byte for byte the file of the whole sweep.
int merge(const std::vector<std::string>& inputs, const std::string& output);

/// Makes SIGINT and SIGTERM stop the work above. Call it once, with both signals blocked in every
/// thread.
void stop_on_signals();

}  // namespace vines::cli
