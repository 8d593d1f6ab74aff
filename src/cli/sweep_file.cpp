// Parses the file of a sweep; `vines merge`: combines the files of its shards.
#include "cli/sweep_file.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>

#include "cli/exit.hpp"
#include "cli/files.hpp"
#include "program/process.hpp"

namespace vines::cli {

namespace {

/// Returns whether a line contains no point.
bool is_between_points(const std::string& type) {
    return type == "done" || type == "progress" || type == "warning" || type == "error";
}

/// Adds the point of a line of the file `name`. Throws std::runtime_error if the present one, from
/// this or another file, differs.
void add_point(
    SweepFile& file, const SweepFile::Line& line, std::size_t index, const std::string& name,
    bool from_other_file) {
    const auto [there, is_new] = file.points.try_emplace(index, line);
    if (!is_new && there->second.text != line.text)
        fail_in_line(
            name, line.number,
            fmt::format(
                "point {} differs from the same point in {}", index,
                from_other_file ? "another file" : fmt::format("line {}", there->second.number)));
}

struct MergeOptions {
    std::vector<std::string> inputs;
    std::string output;
};

/// Adds a shard's points. Throws std::runtime_error if they contradict those of earlier shards.
void add(SweepFile& all, const std::string& path, const std::string& first_path) {
    const SweepFile part = parse_sweep_file(read_file(path), path, LineChecks::full);
    if (part.start.empty()) throw std::runtime_error(path + " is empty");
    if (all.start.empty()) all.start = part.start;
    if (part.start != all.start)
        throw std::runtime_error(fmt::format(
            "{} belongs to another sweep than {}: its first line differs", path, first_path));
    for (const auto& [index, line] : part.points) add_point(all, line, index, path, true);
}

int merge(const MergeOptions& o) {
    SweepFile all;
    for (const std::string& path : o.inputs) add(all, path, o.inputs[0]);
    const api::SweepRequest request = request_of(all, o.inputs[0]);
    if (request.basins)
        throw std::runtime_error(
            "basins of shards are not merged, since their last line needs all starts: put the "
            "lines of points into one file and complete it with vines basins --resume");
    const std::size_t points = request.plan.grid.lines();
    if (all.points.size() < points) {
        std::size_t first = 0;
        while (all.points.contains(first)) ++first;
        print_message(fmt::format(
            "{} of {} points are missing, the first is {}: a shard is not complete or was not "
            "given",
            points - all.points.size(), points, first));
        return incomplete;
    }
    write_all(o.output, all.text(request));
    return complete;
}

}  // namespace

void fail_in_line(const std::string& name, long number, const std::string& fault) {
    throw std::runtime_error(fmt::format("{}, line {}: {}", name, number, fault));
}

std::string SweepFile::text(const api::SweepRequest& request) const {
    std::string all = start + "\n";
    for (const auto& [index, line] : points) all += line.text + "\n";
    return all + api::done_line(points.size(), request);
}

SweepFile parse_sweep_file(const std::string& text, const std::string& name, LineChecks checks) {
    SweepFile file;
    std::optional<api::SweepRequest> request;
    std::optional<api::SweepLineCheck> check;
    long number = 0;
    for (std::size_t end; (end = text.find('\n', file.complete_bytes)) != std::string::npos;
         file.complete_bytes = end + 1) {
        const std::string line = text.substr(file.complete_bytes, end - file.complete_bytes);
        const api::Json json = parse_answer(line);
        const std::string type = word_of(part(json, "/type"));
        ++number;
        if (number == 1 && type == "start") {
            file.start = line;
            request.emplace(request_of(file, name));
            check.emplace(*request);
        } else if (number > 1 && type == "point") {
            const std::string fault = checks == LineChecks::full ? check->fault_of(line, json)
                                                                 : check->fault_of_index(json);
            if (!fault.empty()) fail_in_line(name, number, fault);
            add_point(file, {line, number}, json["index"].get<std::size_t>(), name, false);
            file.done.clear();
        } else if (number == 1 || !is_between_points(type)) {
            fail_in_line(name, number, "not a line of a sweep");
        } else if (type == "done") {
            file.done = line;
        }
    }
    return file;
}

api::SweepRequest request_of(const SweepFile& file, const std::string& name) {
    const api::Json start = parse_answer(file.start);
    const api::Json& request = part(start, "/request");
    if (!request.is_object()) fail_in_line(name, 1, "the request is missing");
    try {
        return request.contains("box") ? api::read_basins_request(request, max_points)
                                       : api::read_sweep_request(request, max_points);
    } catch (const api::Problem& problem) {
        fail_in_line(name, 1, std::string("its request is invalid: ") + problem.what());
    }
}

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
