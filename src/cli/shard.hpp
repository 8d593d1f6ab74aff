// The part of a sweep that one process of many computes.
#pragma once

#include <cstddef>
#include <string>

namespace vines::cli {

/// Part of a sweep that one process computes.
struct Shard {
    std::size_t index = 0;  ///< from 0
    std::size_t count = 1;
};

/// Reads "i/N", "" (the whole sweep), or "auto": then i and N are taken from the environment of a
/// Slurm array or a Kubernetes Indexed Job. Throws Problem 422 for other texts.
Shard read_shard(const std::string& text, std::size_t shards);

}  // namespace vines::cli
