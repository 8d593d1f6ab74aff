// Sweeps over up to three parameters: from a request to the plan that the core carries out.
#pragma once

#include <memory>
#include <vector>

#include "api/request.hpp"
#include "api/sweep_systems.hpp"

namespace vines::api {

struct SweepRequest {
    Json given;  ///< the request without `indices`: what makes two sweeps the same
    Json base;
    std::vector<Axis> axes;    ///< one to three
    std::vector<Json> starts;  ///< at least one; {} for the default start
    SweepPlan plan;
    std::shared_ptr<const SweepSystems> systems;  ///< what the plan asks

    const Axis& reduced_axis() const { return axes[*plan.grid.reduced]; }
};

/// The fields of a point: base, then its start, then its values.
Json fields_of(const SweepRequest& request, const Place& place);

/// Problem 422 with every field at fault; `most_points` bounds the points computed.
SweepRequest read_sweep_request(const Json& object, std::size_t most_points);

/// The part of the wanted lines that shard `shard` of `shards` computes: whole rows where their
/// points are computed together.
std::vector<std::size_t> shard_of(
    const SweepRequest& request, std::size_t shard, std::size_t shards);

}  // namespace vines::api
