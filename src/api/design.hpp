// Requests of /v1/design, and the lines of its NDJSON stream: start, point, progress, done, error.
#pragma once

#include <atomic>
#include <functional>

#include "api/system.hpp"
#include "core/design/design.hpp"

namespace vines::api {

/// A kind of load on the host.
struct Excitation {
    const char* amplitude;  ///< name of the field, or else of the factor on a load
    const char* unit;
    const char* objective;  ///< default
    const char* where;      ///< in words
};

struct DesignRequest {
    Json given;  ///< as requested
    DesignPlan plan;
    const Excitation* excitation = nullptr;
    double amplitude = 1;   ///< the largest, in its unit
    std::string objective;  ///< its name
    SiParameters host;
};

/// Problem 422 naming every invalid field.
DesignRequest read_design_request(const Json& object);
/// The name of a value with a tolerance: of an amplitude, that of the load's field.
const char* name_in(const DesignRequest& request, Toleranced what);

/// Number of absorbers so far; another thread can read it.
using DesignCount = std::atomic<std::size_t>;

/// Passes each line of the result, without line end, to take(); the last one is `done`. False if
/// stopped before the end: `done` then holds what is known, with complete false.
bool run_design(
    const DesignRequest& request, int threads, vines::RunControl& control, DesignCount& count,
    const std::function<void(const std::string& line)>& take);

/// {type: start, version, commit, runs_of, host, request}.
Json design_start(const DesignRequest& request);
/// {type: progress, done, runs, runs_of}: absorbers and motions so far. With line end.
std::string design_progress(
    const DesignRequest& request, const DesignCount& count, const vines::RunControl& control);

}  // namespace vines::api
