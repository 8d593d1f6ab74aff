// Sweeps over up to three parameters: from a request to the points that it stands for.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "api/request.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

struct Axis {
    std::string parameter;
    std::vector<double> values;
};

/// Of the points along one axis only the peak of x over them is told.
struct Reduction {
    std::size_t axis;
    bool largest;  ///< else the smallest
};

struct SweepRequest {
    Json given;  ///< the request without `indices`: what makes two sweeps the same
    Json base;
    std::vector<Axis> axes;    ///< one to three
    std::vector<Json> starts;  ///< at least one; {} for the default start
    bool default_set = false;  ///< every point from default_starts() and from both neighbours
    PointOptions options;
    enum class Carry { none, up, down } carry = Carry::none;
    std::optional<Reduction> reduce;
    std::size_t points = 0;            ///< lines of the whole sweep
    std::vector<std::size_t> indices;  ///< those wanted, ascending

    /// The axis along which a row of points follows each other: the first, or the reduced one.
    std::size_t inner() const { return reduce ? reduce->axis : 0; }
    /// Whether the points of a row are computed together.
    bool by_rows() const { return default_set || reduce || carry != Carry::none; }
};

/// Where a point lies: its start, and its place on each axis.
struct Place {
    std::size_t start;
    std::vector<std::size_t> at;
};
/// Of a line; with a reduction it is at 0 on the reduced axis. Lines count along the first axis
/// (that is not reduced) fastest, then the starts, then the other axes.
Place place_of(const SweepRequest& request, std::size_t index);

/// The fields of a point: base, then its start, then its values.
Json fields_of(const SweepRequest& request, const Place& place);

/// How many lines belong together: a row where its points are computed together and each has a
/// line, else one.
std::size_t chain_length(const SweepRequest& request);

/// Problem 422 with every field at fault; `most_points` bounds the points computed.
SweepRequest read_sweep_request(const Json& object, std::size_t most_points);

/// The part of the wanted lines that shard `shard` of `shards` computes: whole rows where their
/// points are computed together.
std::vector<std::size_t> shard_of(
    const SweepRequest& request, std::size_t shard, std::size_t shards);

}  // namespace vines::api
