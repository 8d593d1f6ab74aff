// How a record's own channel says the oscillator is driven: the acceleration of its base, or a
// force on m1.
#pragma once

#include <optional>
#include <vector>

#include "api/broken_off.hpp"
#include "api/csv.hpp"
#include "api/system.hpp"
#include "core/measurement/joint_fit.hpp"

namespace vines::api {

struct MeasuredForcing {
    bool is_force;
    double f;  ///< Hz
    /// In m/s^2 or N, of sin(2 pi f t) and cos(2 pi f t).
    double sin, cos;
};

/// Of the channel's column; none without one. Problem 422 where it has no one harmonic; BrokenOff.
std::optional<MeasuredForcing> measured_forcing(
    const std::vector<CsvColumn>& columns, const Json& fields, StillWanted& wanted);

/// As that channel has it: the forcing's amplitude, m, and its phase at the time 0.
struct ChannelForcing {
    double amplitude, phase;
};
ChannelForcing channel_forcing(const MeasuredForcing& measured, const System& system);

/// {f, F, phase}, beside what the record says: `phase`, rad, by which the oscillator's motion shows
/// the forcing later than the channel. With a warning where they differ.
Json describe_measured_forcing(
    const MeasuredForcing& measured, const System& used, const JointFit& fit,
    std::vector<std::string>& warnings);

}  // namespace vines::api
