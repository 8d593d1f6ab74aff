// What was measured at the points of a sweep, as its lines.
#pragma once

#include <string>

#include "api/sweep_request.hpp"

namespace vines::api {

/// What each line begins with: {type, index, the values of its axes, start}, without its reduced
/// axis.
Json describe_place(const SweepRequest& request, std::size_t line);

/// The line of one point.
Json describe_point(const SweepRequest& request, std::size_t line, const SweepPoint& point);

/// The line of a row of points, of which one axis is reduced.
Json describe_row(const SweepRequest& request, std::size_t line, const RowSummary& row);

/// What to say of a sweep some of whose motions depend on the start; empty where none does.
std::string start_warning(const StartTrial& trial);

}  // namespace vines::api
