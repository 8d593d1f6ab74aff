// From a measurement of the oscillator, or a list of impacts, to the exponents that it shows.
#pragma once

#include "api/identify_request.hpp"

namespace vines::api {

/// Problem 422 where the record shows no impacts.
Json identify_answer(const IdentifyRequest& request);

}  // namespace vines::api
