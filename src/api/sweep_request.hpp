// Requests of /v1/sweep: up to three swept parameters, read into the plan that the core executes.
#pragma once

#include <memory>

#include "api/request.hpp"
#include "api/system_fields.hpp"
#include "core/sweep/basins.hpp"

namespace vines::api {

/// A swept parameter and its values.
struct Axis {
    std::string parameter;
    std::vector<double> values;
};

/// The systems of a sweep's points, by arithmetic alone: the request is read once.
class SweepSystems {
public:
    /// The numbers of a start, and the fields that it changes.
    struct Start {
        std::size_t base;  ///< index of the fields
        std::vector<std::pair<SystemNumber, double>> numbers;
    };
    /// `bases`: the checked fields of a point, merged with the preset, for each set of fields that
    /// starts have. The numbers of the start and the values of the axes replace theirs.
    SweepSystems(
        std::vector<SystemFields> bases, std::vector<Start> starts, std::vector<Axis> axes,
        long max_impacts);

    /// nullopt if the point's values form no valid system.
    std::optional<PointSystem> at(const Place& place) const;
    /// The system of the first start with another value on the first axis, if there is one.
    std::optional<PointSystem> at_value(double value) const;
    bool has_load() const;
    /// The system in SI if its fields are.
    std::optional<SiParameters> si_at(const Place& place) const;

private:
    struct Column {
        SystemNumber number;
        std::vector<double> values;
    };
    SystemFields fields_at(const Place& place) const;
    std::optional<PointSystem> system_of(const SystemFields& fields) const;

    std::vector<SystemFields> bases_;
    std::vector<Start> starts_;
    std::vector<Column> columns_;
    long max_impacts_;
};

struct SweepRequest {
    Json given;  ///< the request without `indices` and `format`; identifies the sweep
    Json base;
    std::vector<Axis> axes;    ///< one to three; of basins up to one
    std::vector<Json> starts;  ///< at least one; {} for the default start
    SweepPlan plan;
    std::shared_ptr<const SweepSystems> systems;  ///< used by the plan
    std::shared_ptr<Basins> basins = nullptr;     ///< of /v1/basins: collects the results
};

/// The fields of a point: base, overridden by its start, then by its values.
Json fields_of(const SweepRequest& request, const Place& place);

/// Problem 422 naming every invalid field, or if more than `most_points` points would be computed.
SweepRequest read_sweep_request(const Json& object, std::size_t most_points);

/// The grid of a request whose own fields are checked: with `starts` that many at each point, else
/// those that it lists.
SweepRequest read_grid(const Json& given, std::size_t starts, std::size_t most_points);

/// A request of /v1/basins as a sweep over its starts; the same problems.
SweepRequest read_basins_request(const Json& object, std::size_t most_points);

/// The requested lines of shard `shard` of `shards`. Rows computed together stay in one shard.
std::vector<std::size_t> shard_of(
    const SweepRequest& request, std::size_t shard, std::size_t shards);

}  // namespace vines::api
