#include "cli/shard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "api/problem.hpp"
#include "cli/sweep_file.hpp"
#include "program/whole_number.hpp"

namespace vines::cli {

namespace {

// Largest number of shards, and largest id of a Slurm array's first task.
constexpr std::size_t max_shards = max_points;

/// Value of an environment variable; empty if unset.
std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

/// The same as a number. Throws Problem 422 unless it is a whole number from `least` to `most`.
std::size_t number_in_variable(const char* name, std::size_t least, std::size_t most) {
    const std::string text = variable(name);
    if (const auto value = whole_number(text, least, most)) return *value;
    throw api::Problem(
        422,
        fmt::format(
            "{} is {}, not a whole number from {} to {}", name, api::shortened(text), least, most));
}

/// `shards`: N if above 0, in place of SLURM_ARRAY_TASK_COUNT. Throws Problem 422 for a missing or
/// invalid variable.
Shard shard_of_environment(std::size_t shards) {
    if (!variable("SLURM_ARRAY_TASK_ID").empty()) {
        if (shards == 0 && variable("SLURM_ARRAY_TASK_COUNT").empty())
            throw api::Problem(
                422, "--shard auto in a Slurm array needs SLURM_ARRAY_TASK_COUNT or --shards");
        if (shards == 0) shards = number_in_variable("SLURM_ARRAY_TASK_COUNT", 1, max_shards);
        const std::size_t first = variable("SLURM_ARRAY_TASK_MIN").empty()
                                      ? 0
                                      : number_in_variable("SLURM_ARRAY_TASK_MIN", 0, max_shards);
        return {
            number_in_variable("SLURM_ARRAY_TASK_ID", first, first + shards - 1) - first, shards};
    }
    if (variable("JOB_COMPLETION_INDEX").empty())
        throw api::Problem(
            422,
            "--shard auto needs SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT, or "
            "JOB_COMPLETION_INDEX and --shards, in the environment");
    if (shards == 0)
        throw api::Problem(422, "--shard auto with JOB_COMPLETION_INDEX needs --shards");
    return {number_in_variable("JOB_COMPLETION_INDEX", 0, shards - 1), shards};
}

}  // namespace

Shard read_shard(const std::string& text, std::size_t shards) {
    if (text.empty()) return {};
    if (text == "auto") return shard_of_environment(shards);
    const std::size_t slash = std::min(text.find('/'), text.size() - 1);
    const auto count = whole_number(text.substr(slash + 1), 1, max_shards);
    const auto index = whole_number(text.substr(0, slash), 0, count.value_or(1) - 1);
    if (!index || !count)
        throw api::Problem(
            422, fmt::format("a shard is i/N with 0 <= i < N, not {}", api::shortened(text)));
    return {*index, *count};
}

}  // namespace vines::cli
