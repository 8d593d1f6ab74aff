// Requests and answers of /v1/identify: from a record or a list of impacts to Lyapunov exponents.
#pragma once

#include <set>
#include <string_view>

#include "api/cancellation.hpp"
#include "api/system.hpp"
#include "core/measurement/measurement.hpp"

namespace vines::api {

/// The forcing measured by a channel of the record: the motion of the base, or a force on m1.
struct MeasuredForcing {
    LoadKind kind;
    double f;  ///< Hz
    /// Coefficients of sin(2 pi f t) and cos(2 pi f t), in m/s^2, m or N.
    double sin, cos;
};

struct IdentifyRequest {
    System system;  ///< R is valid only if given
    Measurement measurement;
    std::optional<MeasuredForcing> forcing;  ///< from a channel of the record
    bool forcing_fitted = false;             ///< G comes from the measurement
    std::set<std::string> include;           ///< additional parts of the answer
    std::size_t most_points;                 ///< of the motion
};

/// Reads JSON {fields..., record: {time_s, displacement_m, acceleration_m_s2}} or {fields...,
/// impacts: {...}}. Problem 422 for invalid fields; throws Cancelled.
IdentifyRequest read_identify_request(Json object, const ReadLimits& limits = {});
/// Reads a CSV file and the other fields. Also Problem 413 beyond `limits`.
IdentifyRequest read_identify_request(
    const Json& fields, std::string_view csv, const ReadLimits& limits = {});

/// Problem 422 if the record shows no impacts; Problem 413 naming the stage if `watch` stops it.
Json identify_answer(const IdentifyRequest& request, const IdentificationWatch& watch = {});

/// A stage in words: "looking for spikes", "refining the impacts, round 3", ...
std::string words_of(IdentificationStage stage, int round);

}  // namespace vines::api
