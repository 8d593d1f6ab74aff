// A measurement from the text of a CSV file or from JSON.
#pragma once

#include <set>
#include <string_view>

#include "api/measured_forcing.hpp"
#include "api/reading.hpp"
#include "api/request.hpp"
#include "core/measurement/measurement.hpp"

namespace vines::api {

struct IdentifyRequest {
    System system;  ///< R only where it is given
    Measurement measurement;
    std::optional<MeasuredForcing> forcing;  ///< by a channel of the record
    bool forcing_fitted = false;             ///< G is what the measurement says
    std::vector<std::string> notes;          ///< what is odd about the record
    std::set<std::string> include;           ///< parts of the answer beside the usual ones
    std::size_t most_points;                 ///< of the motion

    bool includes(const char* part) const { return include.contains(part); }
};

/// From JSON {fields..., record: {time_s, displacement_m, acceleration_m_s2}} or {fields...,
/// impacts: {...}}. Problem 422 with what is at fault; BrokenOff where `reading` gives up.
IdentifyRequest read_identify_request(Json object, const Reading& reading = {});
/// From the text of a CSV file and the fields beside it. 413 beyond what `reading` lets it hold.
IdentifyRequest read_identify_request(
    const Json& fields, std::string_view csv, const Reading& reading = {});

}  // namespace vines::api
