// From a measurement of the oscillator, or a list of impacts, to the exponents that it shows.
#pragma once

#include <string_view>

#include "api/request.hpp"
#include "core/identification/identify.hpp"

namespace vines::api {

struct IdentifyRequest {
    System system;  ///< R only where R_given
    bool R_given;
    MeasuredRecord record;        ///< empty where the impacts are given with their states
    std::vector<double> moments;  ///< tau of the impacts, edited by the user; empty: find them
    std::vector<IdentifiedImpact> impacts;  ///< with their states, in place of a record
    double threshold;                       ///< of a spike, in standard deviations of the noise
    ExponentOptions estimators;
    std::vector<std::string> notes;  ///< what is odd about the record
};

/// From JSON {fields..., record: {time_s, displacement_m, acceleration_m_s2}} or {fields...,
/// impacts: {...}}.
IdentifyRequest read_identify_request(const Json& object);
/// From the text of a CSV file and the fields beside it.
IdentifyRequest read_identify_request(const Json& fields, std::string_view csv);

Json identify_answer(const IdentifyRequest& request);

}  // namespace vines::api
