// One point of a sweep: its starts, the measurement of a motion (a transient, then a measured
// part), and the motions found at the point.
//
// Several starts can lead to different steady states. The worst motion of a point is the one with
// the largest objective (peak); a row of points is summarised by its extreme peaks.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/analysis/analysis.hpp"
#include "core/measures/attractor.hpp"
#include "core/measures/extremes.hpp"
#include "core/motion/parameters.hpp"
#include "core/sweep/parallel.hpp"

namespace vines {

struct NamedStart {
    const char* name;
    State state;
};
/// Starts of different energy that show whether the steady state depends on the start:
/// - middle: all at rest, the ball in the middle of its cavity;
/// - wall: the default start, next to a wall;
/// - moving: the oscillator in its steady motion without absorber, the ball at rest in the middle
/// of the cavity;
/// - untouched: the same with the ball at rest at y = 0, if that motion is smaller than b: it then
/// lasts for ever.
std::vector<NamedStart> default_starts(const Parameters& parameters);

/// Starts per point: default_starts() and the last states of both neighbours.
inline constexpr std::size_t most_starts = 6;

/// State at which a run with other parameters takes over: the ball keeps its place in the cavity.
/// `faster`: omega0 of `to` over that of `from`; velocities in m/s stay.
State carried(const State& state, const Parameters& from, const Parameters& to, double faster = 1);

class KnownMotions;

/// True for those that need PointOptions::peaks.
constexpr bool is_peak(Objective o) {
    return o == Objective::x_relative_max || o == Objective::x_acceleration_max;
}

/// Units of SI for objectives; both are 1 for a reduced system.
struct ObjectiveUnits {
    double omega0 = 1, m1 = 1;  ///< rad/s, kg
};

/// Section that a sweep keeps for a bifurcation diagram.
enum class SectionKind { none, impact, stroboscopic };

struct PointOptions {
    double transient_cycles = 200;  ///< run before the measurement; whole cycles
    double cycles = 1000;           ///< measured; whole cycles
    /// Cycles for which a chaotic motion is continued to see whether an orbit captures it.
    double settle_cycles = 0;
    long max_impacts = 1000000;  ///< of the measured part; see transient_impacts_per_cycle
    SectionKind section = SectionKind::none;
    std::size_t section_points = 200;  ///< keeps the last ones
    double section_phase = 0;          ///< stroboscopic section: rad after each whole cycle
    /// A neighbour continues from the last state: computes PointResult::at_end.
    bool carry = false;
    /// Only objective, impacts and their extremes; x_max without `peaks`, x_rms if it is asked for.
    bool amplitudes_alone = false;
    Objective objective = Objective::x_max;
    bool peaks = false;  ///< Extremes::x_acceleration and x_relative, too
    ObjectiveUnits units = {};
    /// Ends the transient as soon as it reaches one of these motions, which then is the result.
    const KnownMotions* known = nullptr;
};

struct PointResult {
    /// False if the transient did not end; then only `outcome` is valid.
    bool measured = false;
    /// End of the measured part, or of the transient if that did not end.
    Outcome outcome;
    /// With PointOptions::carry: state at the first whole cycle at or after the measured part.
    std::optional<State> at_end;
    Exponents lambda, standard_error;  ///< qr
    bool stationary = true;  ///< false: standard errors do not cover (warning::NotStationary)
    /// On the orbit that captures the motion, if one does; otherwise on the measured part.
    Verdict verdict;
    /// lambda1 up to the capture and of the orbit; empty without a capture.
    std::optional<double> lambda1_before, lambda1_after;
    std::optional<double> capture_cycle;  ///< of the measured part, or after it
    /// Cycles, from the start of the measured part, for which a motion is known to be chaotic:
    /// until its capture, or as long as it was followed. Empty if no chaos is shown.
    std::optional<double> chaotic_cycles;
    Regime regime;  ///< without its lists
    AttractorName name;
    /// m; m; x_rms over that of the steady motion (free decay: same start) without absorber.
    double x_max, x_rms = nan, x_rms_ratio = nan;
    Extremes extremes;         ///< two of them with PointOptions::peaks
    double decay_tenth = nan;  ///< DecayTimes::tenth; infinity after the run's end
    double objective;          ///< by which motions are ranked
    double x_rms_error = nan, share_impacts_error = nan;  ///< standard errors (EnergyBalance)
    /// Steady amplitude without absorber, m; empty at undamped resonance.
    std::optional<double> x_free;
    std::optional<double> share_impacts;  ///< fraction of dissipation; empty without dissipation
    Sections sections;                    ///< of the requested kind
};

/// Limit of impacts per cycle in the transient, which only endless chatter (R = 1) reaches.
inline constexpr long transient_impacts_per_cycle = 1000;

/// Runs one point from a state at tau = 0. Invalid once `stop` (as in Limits) returned true.
PointResult measure(
    const Parameters& parameters, const State& start, const PointOptions& options,
    const StopRequest& stop);

/// The measured part of a run from tau = 0. A load is measured as a whole; if it has no end or is a
/// shock, for the measured cycles. The transient of a harmonic forcing is a run of its own.
Interval measured_part(const Parameters& parameters, const PointOptions& options);

/// True if two runs of the same point clearly end in different motions: only one has impacts, or
/// the periods or the impacts per period differ, or the rms of x differs by 1 % between periodic
/// motions, by a fourth between others.
bool differs_in_steady_state(const PointResult& one, const PointResult& other);

struct PointSystem {
    Parameters parameters;
    State start;
    long max_impacts;
    std::shared_ptr<const KnownMotions> known = nullptr;
    ObjectiveUnits units = {};
};

/// A motion and its start, named in the default set of starts, else unnamed.
struct Motion {
    std::string start;
    State from;
    PointResult result;
};

struct SweepPoint {
    std::optional<PointSystem> system;  ///< empty: the values make no valid system
    /// The neighbour had no last state at a whole cycle to continue from.
    bool afresh = false;
    std::vector<Motion> motions = {};
    std::optional<Motion> second = {};  ///< from a second start, to detect dependence on the start
};

/// Lifetime of chaotic transients, in forcing cycles, from motions of which some were captured.
struct Lifetime {
    std::optional<double> mean;       ///< cycles of chaos per capture
    std::optional<double> low, high;  ///< 95 % interval; `high` and `mean` empty without a capture
    int captured, runs;
};
/// Lifetime for captures at a constant rate; empty values without a motion of shown chaos.
Lifetime lifetime_of(std::span<const Motion> motions);

/// Measured motions in ascending order of the objective: the worst is the last.
std::vector<const Motion*> ranked(const SweepPoint& point);

/// True if the point's steady state depends on the start. Empty if no second motion was measured,
/// or not all of a default set without a difference.
std::optional<bool> depends_on_start(const SweepPoint& point, bool default_set);

/// Highest or lowest objective along a row.
struct Peak {
    std::size_t at = 0;              ///< index of the point in the row
    const Motion* motion = nullptr;  ///< null if nothing was measured
};

/// Summary of a row of points; refers to the motions of the row, which must outlive it.
struct RowSummary {
    Peak worst;  ///< over the worst motion of each point
    Peak best;   ///< over the best motion of each point
    struct FromStart {
        std::string start;
        Peak peak;
    };
    std::vector<FromStart> starts;  ///< for each start
    std::optional<double> x_free;   ///< peak amplitude without absorber
    std::size_t points = 0;         ///< points in the row
    std::size_t missing = 0;        ///< points without a measured motion
    /// True if the steady state depends on the start at one of the points where that was tested.
    std::optional<bool> depends_on_start;
};
/// Summary of a row: the largest peaks, or without `largest` the smallest.
RowSummary summary_of(std::span<const SweepPoint> row, bool largest, bool default_set);

/// Computes a motion by measure(), with a permit. Throws Stopped on a stop request.
PointResult run_point(
    const PointSystem& system, const State& start, PointOptions options, RunControl& control);

}  // namespace vines
