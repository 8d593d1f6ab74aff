// The parts of reading and describing a measurement, each in a file of its own.
#pragma once

#include "api/csv.hpp"
#include "api/identify.hpp"

namespace vines::api {

// The columns of a record (record_columns.cpp).

/// The names of the columns, shortened for a message.
std::vector<std::string> names_of(const std::vector<CsvColumn>& columns);

struct RecordColumn {
    const CsvColumn* column;  ///< null if missing
    double factor;            ///< to SI
};
/// The column named by the request, else the default, else the first with one of the beginnings.
/// Its unit is that of its name (displacement_mm, time (ms), acceleration [g]) or of the row of
/// units, else that of the request's field, else the default. Problem 422 for an unknown unit or
/// contradictory ones.
RecordColumn find_column(
    const std::vector<CsvColumn>& columns, const Json& fields, const Channel& channel);

// Values fitted to a record: sensors, forcing, oscillator (fitted_unknowns.cpp).

/// The model's forcing from a channel: amplitude in m, and phase at t = 0 in rad.
struct ChannelForcing {
    double amplitude, phase;
};
ChannelForcing channel_forcing(const MeasuredForcing& measured, const System& system);

/// {f, F, phase, load}. `phase` is the lag of the forcing in the oscillator's motion after the
/// channel, in rad. Warns if amplitudes or phases disagree.
Json describe_measured_forcing(
    const MeasuredForcing& measured, const System& used, const JointFit& fit, Warnings& warnings);

/// Values of the field `fixed` in addition to the names of Unknown.
inline constexpr const char *fixed_amplitude = "F", *fixed_phase = "phase";
/// Ignores names that are not of Unknown.
FixedUnknowns fixed_of(const std::set<std::string>& names);

/// {name: {value, standard_error, fixed}} for each Unknown, and for F and phase of the forcing.
/// `parameters`: those in use, with the fitted Omega. `omega0`: as given, in rad/s.
Json describe_fitted(const JointFit& fit, const Parameters& parameters, double omega0);
/// The laws of the ball in SI; `wanted`: those that were fitted. Null without a result.
Json describe_laws(const std::optional<FittedLaws>& laws, const BallLaws& wanted, double omega0);

/// Warns of sensors or given values that the record contradicts.
void add_fitted_warnings(
    const JointFit& fit, const UnknownValues& given, double omega0, Warnings& warnings);

// A list of impacts (identify_impacts.cpp).

/// True if a list has the phase of the forcing at its impacts; otherwise the forcing is fitted.
bool has_phase(const Json& impacts);

/// Reads columns of impacts into the request's measurement; notes report fitted values. Problem 422
/// for invalid columns, Problem 413 for more than `most` impacts; throws Cancelled.
void read_impact_list(
    IdentifyRequest& request, Json impacts, std::size_t most, CancelCheck& cancel);

}  // namespace vines::api
