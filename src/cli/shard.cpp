#include "cli/shard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>

#include "api/problem.hpp"

namespace vines::cli {

namespace {

/// A whole number from 0 on, or -1.
long number(const std::string& text) {
    char* end = nullptr;
    errno = 0;
    const long value = std::strtol(text.c_str(), &end, 10);
    return text.empty() || *end || errno || value < 0 ? -1 : value;
}

Shard checked(const std::string& index, const std::string& of) {
    const long i = number(index), n = number(of);
    if (i < 0 || n < 1 || i >= n)
        throw api::Problem(
            422, fmt::format("a shard is i/N with 0 <= i < N, not {}/{}", index, of));
    return {static_cast<std::size_t>(i), static_cast<std::size_t>(n)};
}

/// "" where it is not set.
std::string variable(const char* name) {
    const char* value = std::getenv(name);
    return value ? value : "";
}

Shard of_environment(const std::string& shards) {
    if (const std::string id = variable("SLURM_ARRAY_TASK_ID"); !id.empty()) {
        const long first = std::strtol(variable("SLURM_ARRAY_TASK_MIN").c_str(), nullptr, 10);
        return checked(
            fmt::format("{}", std::strtol(id.c_str(), nullptr, 10) - first),
            shards.empty() ? variable("SLURM_ARRAY_TASK_COUNT") : shards);
    }
    if (const std::string index = variable("JOB_COMPLETION_INDEX"); !index.empty())
        return checked(index, shards);
    throw api::Problem(
        422,
        "--shard auto needs SLURM_ARRAY_TASK_ID and SLURM_ARRAY_TASK_COUNT, or "
        "JOB_COMPLETION_INDEX and --shards, in the environment");
}

}  // namespace

Shard read_shard(const std::string& text, int shards) {
    if (text.empty()) return {};
    if (text == "auto") return of_environment(shards > 0 ? fmt::format("{}", shards) : "");
    const std::size_t slash = std::min(text.find('/'), text.size());
    return checked(text.substr(0, slash), slash < text.size() ? text.substr(slash + 1) : "");
}

}  // namespace vines::cli
