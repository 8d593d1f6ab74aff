// Sweeps over one or two parameters: from a request to lines of NDJSON, point by point.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "api/request.hpp"
#include "core/sweep.hpp"

namespace vines::api {

struct Axis {
    std::string parameter;
    std::vector<double> values;
};

struct SweepRequest {
    Json given;               ///< the request without `indices`: what makes two sweeps the same
    Json base;
    std::vector<Axis> axes;   ///< one or two
    std::vector<Json> starts; ///< at least one; {} for the default start
    PointOptions options;
    enum class Carry { none, up, down } carry;
    std::size_t points;       ///< of the whole sweep: axes' counts times starts
    std::vector<std::size_t> indices;  ///< those wanted, ascending
};

/// Problem 422 with every field at fault; `most_points` bounds the sweep.
SweepRequest read_sweep_request(const Json& object, std::size_t most_points);

/// What a sweep asks of the place that it runs in.
class Pace {
public:
    virtual ~Pace() = default;
    virtual void begin() {}                   ///< before a point is computed, on the thread that does it
    virtual void end() {}
    virtual bool stop_or_yield() { return false; }  ///< asked every few events; true stops the sweep
};

/// {type: start, version, points, cycles, axes, request}: the same for each part of the same sweep.
Json sweep_start(const SweepRequest& request);

/// Computes the points wanted on so many threads and hands out each as a line {type: point, index, ...}, in the order in
/// which they come. `point` is called by one thread at a time. A point's line depends on the request and its index alone.
void run_sweep(const SweepRequest& request, int threads, Pace& pace, const std::function<void(std::size_t index, const Json& line)>& point);

/// The part of the wanted points that shard `shard` of `shards` computes: whole chains where state is carried.
std::vector<std::size_t> shard_of(const SweepRequest& request, std::size_t shard, std::size_t shards);

}  // namespace vines::api
