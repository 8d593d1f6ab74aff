// From a measurement of the oscillator, or a list of impacts, to the exponents that it shows.
#pragma once

#include "api/identify_request.hpp"

namespace vines::api {

/// Problem 422 where the record shows no impacts, 413 with the stage that was reached where the
/// watch stops it.
Json identify_answer(const IdentifyRequest& request, const IdentificationWatch& watch = {});

/// "looking for spikes", "refining the impacts, round 3", ...
std::string words_of(IdentificationStage stage, int round);

}  // namespace vines::api
