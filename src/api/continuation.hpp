// Requests of /v1/continue, and the lines of its NDJSON stream.
#pragma once

#include "api/line_stream.hpp"
#include "api/properties.hpp"
#include "api/system.hpp"
#include "core/continuation/branch.hpp"

namespace vines::api {

struct ContinueRequest {
    Json given;  ///< as requested
    std::string parameter;
    StartedSystem base;
    double at;  ///< the parameter's value in the base
    BranchPlan plan;
    bool settles;       ///< the first orbit is the one on which the base settles
    int period_cycles;  ///< else that of the stated one
    PointOptions settling;
    std::optional<SpecialKind> curve;  ///< follow these points in two parameters
    std::string second;                ///< of a curve: name of the second parameter
    double second_at = 0;              ///< its value in the base
    ParameterFamily curve_family;      ///< of both parameters
};

/// Problem 422 naming every invalid field.
ContinueRequest read_continue_request(const Json& object);

/// Lines start, branch, point, special, progress, done; computed on one thread.
std::shared_ptr<LineStream> continuation_lines(ContinueRequest request);

namespace properties {

/// Plain values of an orbit on a branch; `share_impacts` can be null.
inline constexpr Property<OrbitPoint> branch_point[] = {
    {{"stable", "true if all multipliers lie inside the unit circle", flag},
     at<&OrbitPoint::stable>},
    {{"z", "impacts per forcing cycle"},
     [](const OrbitPoint& o) {
         return Json(static_cast<double>(o.sequence.impacts()) / o.sequence.cycles());
     }},
    {{"period_cycles", "period in forcing cycles", whole},
     at<&OrbitPoint::sequence, &ImpactSequence::cycles>},
    {{"impacts", "impacts per period", whole}, at<&OrbitPoint::sequence, &ImpactSequence::impacts>},
    {{"sticks", "sticking phases per period; the chatter before one is one impact", whole},
     [](const OrbitPoint& o) { return Json(o.sequence.sticks * (o.sequence.mirrored ? 2 : 1)); }},
    {{"symmetric", "true if a shift by half a period gives the mirror image", flag},
     at<&OrbitPoint::sequence, &ImpactSequence::mirrored>},
    {{"x_max", "maximum of |x| over the period, m"},
     at<&OrbitPoint::measures, &OrbitMeasures::x_max>},
    {{"x_rms", "rms of x, m"}, at<&OrbitPoint::measures, &OrbitMeasures::x_rms>},
    {{"share_impacts", "fraction of the dissipated energy; null if none is dissipated",
      number_or_null},
     at<&OrbitPoint::measures, &OrbitMeasures::share_impacts>},
};

}  // namespace properties

}  // namespace vines::api
