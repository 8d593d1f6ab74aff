// `vines merge`: combines the files of a sweep's shards.
#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "cli/sweep_file.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

struct MergeOptions {
    std::vector<std::string> inputs;
    std::string output;
};

/// Adds a shard's points. Throws std::runtime_error if a line is invalid, the shard belongs to
/// another sweep, or its value of a point differs from an earlier shard's.
void add(SweepFile& all, const std::string& path, const std::string& first_path) {
    const SweepFile part = parse_sweep_file(read_file(path), path, LineChecks::full);
    if (part.start.empty()) throw std::runtime_error(path + " is empty");
    if (all.start.empty()) all.start = part.start;
    if (part.start != all.start)
        throw std::runtime_error(fmt::format(
            "{} belongs to another sweep than {}: its first line differs", path, first_path));
    for (const auto& [index, line] : part.points) {
        const auto [there, added] = all.points.try_emplace(index, line);
        if (!added && there->second.text != line.text)
            fail_in_line(
                path, line.number,
                fmt::format("point {} differs from the same point in another file", index));
    }
}

std::size_t first_missing(const SweepFile& file) {
    std::size_t first = 0;
    for (const auto& [index, line] : file.points) {
        if (index != first) break;
        ++first;
    }
    return first;
}

int merge(const MergeOptions& o) {
    SweepFile all;
    for (const std::string& path : o.inputs) add(all, path, o.inputs[0]);
    const std::size_t points = request_of(all, o.inputs[0]).plan.grid.lines();
    if (all.points.size() < points) {
        print_message(fmt::format(
            "{} of {} points are missing, the first is {}: a shard is not complete or was not "
            "given",
            points - all.points.size(), points, first_missing(all)));
        return incomplete;
    }
    write_all(o.output, all.text());
    return complete;
}

}  // namespace

Command add_merge(CLI::App& app) {
    const auto options = std::make_shared<MergeOptions>();
    CLI::App* command = app.add_subcommand("merge", "combine the files of a sweep's shards");
    add_file(*command, "files", options->inputs, "the shards' files")->required();
    add_output(*command, options->output, "file for the whole sweep; - or nothing: stdout");
    return with_exit_codes(
        command, [options] { return merge(*options); },
        "vines merge 0.ndjson 1.ndjson 2.ndjson 3.ndjson -o sweep.ndjson");
}

}  // namespace vines::cli
