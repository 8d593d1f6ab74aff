// The forcing measured by a channel of the record: the acceleration of the base, or a force on m1.
#pragma once

#include <optional>
#include <vector>

#include "api/cancellation.hpp"
#include "api/csv.hpp"
#include "api/system.hpp"
#include "core/measurement/joint_fit.hpp"

namespace vines::api {

struct MeasuredForcing {
    bool is_force;
    double f;  ///< Hz
    /// Coefficients of sin(2 pi f t) and cos(2 pi f t), in m/s^2 or N.
    double sin, cos;
};

/// Fits a harmonic to the channel's column; nullopt without a channel. Problem 422 if one harmonic
/// does not describe it; throws Cancelled.
std::optional<MeasuredForcing> measured_forcing(
    const std::vector<CsvColumn>& columns, const Json& fields, CancelCheck& cancel);

/// The model's forcing from a channel: amplitude in m, and phase at t = 0 in rad.
struct ChannelForcing {
    double amplitude, phase;
};
ChannelForcing channel_forcing(const MeasuredForcing& measured, const System& system);

/// {f, F, phase}. `phase` is the lag of the forcing in the oscillator's motion after the
/// channel, in rad. Warns if amplitudes or phases disagree.
Json describe_measured_forcing(
    const MeasuredForcing& measured, const System& used, const JointFit& fit,
    std::vector<std::string>& warnings);

}  // namespace vines::api
