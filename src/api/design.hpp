// Requests of /v1/design, and the lines of its NDJSON stream.
#pragma once

#include "api/line_stream.hpp"
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
DesignRequest read_design_request(const Json& object, const std::function<bool()>& gives_up = {});
/// The name of a value with a tolerance: of an amplitude, that of the load's field.
const char* name_in(const DesignRequest& request, Toleranced what);

/// Lines start, point, sample, progress, done. An early end has a line done, too: what is known,
/// with complete false.
std::shared_ptr<LineStream> design_lines(DesignRequest request);

}  // namespace vines::api
