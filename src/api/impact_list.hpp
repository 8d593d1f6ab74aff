// A list of impacts in place of a record: as a simulation or an identification gives them, or what
// a laboratory knows of them.
#pragma once

#include "api/broken_off.hpp"
#include "api/identify_request.hpp"

namespace vines::api {

/// Whether a list has the forcing's phase at its impacts; if not, the forcing is fitted to it.
bool says_forcing(const Json& impacts);

/// Columns of impacts into the request's measurement; notes say what was fitted. Problem 422 with
/// what is at fault; BrokenOff.
void read_impact_list(IdentifyRequest& request, Json impacts, StillWanted& wanted);

}  // namespace vines::api
