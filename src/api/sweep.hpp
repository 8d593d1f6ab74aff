// Requests of /v1/sweep and /v1/basins, read into the plan that the core executes, and their lines.
#pragma once

#include "api/cancellation.hpp"
#include "api/line_stream.hpp"
#include "api/system.hpp"
#include "core/sweep/basins.hpp"

namespace vines::api {

/// A swept parameter and its values.
struct Axis {
    std::string parameter;
    std::vector<double> values;
};

/// The systems of a sweep's points, by arithmetic alone: the request is read once.
struct SweepSystems {
    /// Starts that give the same fields.
    struct Kind {
        std::vector<std::string> names;
        /// Checked, and merged with the preset. Those of the start and the axes replace them.
        SystemFields fields;
    };
    struct Start {
        std::size_t kind;
        std::vector<double> values;  ///< of the names of the kind
    };
    std::vector<Kind> kinds = {};
    std::vector<Start> starts = {};
    std::vector<Axis> axes = {};
    long max_impacts = 0;

    /// nullopt if the point's values form no valid system.
    std::optional<PointSystem> at(const Place& place) const;
    /// True if the point's values form a valid system, whatever its load.
    bool is_valid(const Place& place) const;
    /// The system of the first start with another value on the first axis, if there is one.
    std::optional<PointSystem> at_value(double value) const;
    bool has_load() const;
    /// The system in SI if its fields are.
    std::optional<SiParameters> si_at(const Place& place) const;

private:
    SystemFields fields_at(const Place& place) const;
    SystemFields unforced_at(const Place& place) const;
    std::optional<PointSystem> system_of(const SystemFields& fields) const;
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
SweepRequest read_sweep_request(
    const Json& object, std::size_t most_points, const CancelCheck& cancel = CancelCheck({}));

/// The grid of a request whose own fields are checked: with `starts` that many at each point, else
/// those that it lists.
SweepRequest read_grid(
    const Json& given, std::size_t starts, std::size_t most_points, const CancelCheck& cancel);

/// A request of /v1/basins as a sweep over its starts; the same problems.
SweepRequest read_basins_request(
    const Json& object, std::size_t most_points, const CancelCheck& cancel = CancelCheck({}));

/// The requested lines of shard `shard` of `shards`. Rows computed together stay in one shard.
std::vector<std::size_t> shard_of(
    const SweepRequest& request, std::size_t shard, std::size_t shards);

/// Computes the requested lines on `threads` threads. Calls take(index, line) with {type: point,
/// index, ...} without line end, in order of completion, from one thread at a time. Returns a
/// warning about the whole sweep; empty if there is none.
std::string run_sweep(
    const SweepRequest& request, int threads, RunControl& control,
    const std::function<void(std::size_t index, const std::string& line)>& take);

/// {type: start, version, points, cycles, axes, parameters, warnings, request}: identical for all
/// parts of a sweep.
Json sweep_start(const SweepRequest& request);

/// The line {type: done, points}: the sweep is complete, with `points` lines of points. With a
/// request of basins also describe_basins().
std::string done_line(std::size_t points, const SweepRequest& request);

/// First members of each line: {type, index, values of the axes, start}, without a reduced axis.
Json describe_place(const SweepRequest& request, std::size_t line);
/// The line of one point, or of a row of points along a reduced axis.
Json describe_point(const SweepRequest& request, std::size_t line, const SweepPoint& point);
Json describe_row(const SweepRequest& request, std::size_t line, const RowSummary& row);

/// {attractors, basins}: the result of /v1/basins.
Json describe_basins(const SweepRequest& request);

// Lines that can belong to a sweep.

/// Lines of made-up results that together have every field that a line of the sweep can have.
std::vector<Json> sample_lines(const SweepRequest& request);

class SweepLineCheck {
public:
    /// The request must outlive the object.
    explicit SweepLineCheck(const SweepRequest& request);

    /// The fault of a point's line, given as text and parsed; empty if none. Faults: an index
    /// outside the sweep; a place that differs from that of the index in any bit; a missing or
    /// unknown field, or one of another type; text that this program would write differently.
    std::string fault_of(const std::string& line, const Json& parsed) const;
    /// The fault of the index alone.
    std::string fault_of_index(const Json& parsed) const;

private:
    std::string fault_of_place(const std::string& line, const Json& parsed) const;

    const SweepRequest& request_;
    // Sample lines with every possible set of fields: with a second start, without, and for values
    // that form no valid system.
    std::vector<Json> tried_, single_, without_system_;
};

}  // namespace vines::api
