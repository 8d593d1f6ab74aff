// Which part of a sweep a process computes.
#pragma once

#include <cstddef>
#include <string>

namespace vines::cli {

struct Shard {
    std::size_t index = 0;  ///< from 0
    std::size_t of = 1;
};

/// From "i/N", from "" (the whole), or from "auto": then i and N are those of the environment of a
/// Slurm array or a Kubernetes Indexed Job, N `shards` where that is above 0. Problem 422 where it
/// is none of them.
Shard read_shard(const std::string& text, int shards);

}  // namespace vines::cli
