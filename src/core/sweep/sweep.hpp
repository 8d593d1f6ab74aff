// What is measured at one point of a parameter plane, whether it depends on the start, and many
// points on all cores.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/measures/regime.hpp"

namespace vines {

/// Which points of the motion a sweep keeps for a bifurcation diagram.
enum class Section { none, impact, stroboscopic };

struct PointOptions {
    double transient_cycles = 200;  ///< run before anything is measured; whole cycles
    double cycles = 1000;           ///< measured; whole cycles
    long max_impacts = 1000000;     ///< of the measured part; the transient has its own limit
    Section section = Section::none;
    std::size_t section_points = 200;  ///< the last so many
    double section_phase = 0;          ///< of a stroboscopic section: rad after each whole cycle
    /// Whether a neighbour goes on from the last state: PointResult::at_end.
    bool carry = false;
};

/// One point of a section. At impact: side, phase, x, x' and y' after the impact, and the time
/// since the impact before (NaN for the first). At whole cycles: x, x', y, y'.
struct SectionPoint {
    int side;
    double phase, x, x_dot, y, y_dot, time_difference;
};

struct PointResult {
    /// False: the transient did not end, and nothing else here has a meaning.
    bool measured = false;
    /// Of the measured part, or of the transient where there is none; what it ended by.
    Outcome outcome;
    /// At a whole cycle at or behind the measured part's end; with PointOptions::carry.
    std::optional<State> at_end;
    Exponents lambda, standard_error;  ///< qr
    Verdict verdict;
    Regime regime;  ///< without its lists
    /// M, m, over that of the steady motion without the absorber (free: of the same start)
    double x_max, x_rms, x_rms_ratio;
    /// Steady amplitude without the absorber, m; none undamped at resonance.
    std::optional<double> x_free;
    double share_impacts;  ///< of the dissipated energy; NaN where nothing is dissipated
    long impacts, sticks;
    std::vector<SectionPoint> section;
};

/// A transient may have so many impacts a cycle: far more than any motion has that is not a chatter
/// without end (R = 1).
inline constexpr long transient_impacts_per_cycle = 1000;

/// Runs one point from a state at tau = 0. `stop` as in Limits; once it says true the result is
/// worthless.
PointResult measure(
    const Parameters& parameters, const State& start, const PointOptions& options,
    const std::function<bool()>& stop);

/// The state that a run of other parameters takes over: the same motion, the free mass at the same
/// place of its cavity.
State carried(const State& state, const Parameters& from, const Parameters& to);

/// A start that shows whether the motion depends on it.
struct NamedStart {
    const char* name;
    State state;
};
/// Starts of different energy: middle (all at rest, the free mass in the middle of its cavity),
/// wall (the default start, next to a wall); with the oscillator in its steady motion without the
/// absorber, where there is one: moving (the free mass at rest in the middle of the cavity as it is
/// then) and, where that motion is smaller than b, untouched (the free mass at rest at y = 0, which
/// is then a motion for ever).
std::vector<NamedStart> default_starts(const Parameters& parameters);

/// Whether two runs of the same point end in different motions, as far as this shows without a
/// doubt: only one without impacts, or different periods or impacts per period, or an rms of x that
/// differs by 1 % between periodic ones, by a fourth between others.
bool ends_elsewhere(const PointResult& one, const PointResult& other);

/// Calls task(0), ..., task(count - 1), each once, from so many threads, and returns when all are
/// done. A task that throws ends the work: the exception comes out of here once the other threads
/// are back.
void parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

}  // namespace vines
