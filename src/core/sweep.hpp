// What is measured at one point of a parameter plane, and many of them on all cores.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "core/regime.hpp"

namespace vines {

/// Which points of the motion a sweep keeps for a bifurcation diagram.
enum class Section { none, impact, stroboscopic };

struct PointOptions {
    double transient_cycles = 200;   ///< run before anything is measured; whole cycles
    double cycles = 1000;            ///< measured; whole cycles
    long max_impacts = 1000000;      ///< of the measured part; the transient has its own limit
    Section section = Section::none;
    std::size_t section_points = 200;  ///< the last so many
    bool carry = false;                ///< whether a neighbour goes on from the last state: PointResult::at_end
};

/// One point of a section. At impact: side, phase, x, x' and y' after the impact, and the time since the impact before
/// (NaN for the first). At whole cycles: x, x', y, y'.
struct SectionPoint {
    int side;
    double phase, x, x_dot, y, y_dot, time_difference;
};

struct PointResult {
    bool measured = false;           ///< false: the transient did not end, and nothing else here has a meaning
    Outcome outcome;                 ///< of the measured part, or of the transient where there is none; what it ended by
    std::optional<State> at_end;     ///< at a whole cycle at or behind the measured part's end; with PointOptions::carry
    Exponents lambda, standard_error;    ///< qr
    Verdict verdict;
    Regime regime;
    double x_max, x_rms, x_rms_ratio;  ///< m, m, over that without the absorber
    double share_impacts;            ///< of the dissipated energy; NaN where nothing is dissipated
    long impacts, sticks;
    std::vector<SectionPoint> section;
};

/// A transient may have so many impacts a cycle: far more than any motion has that is not a chatter without end (R = 1).
inline constexpr long transient_impacts_per_cycle = 1000;

/// Runs one point from a state at tau = 0. `stop` as in Limits; once it says true the result is worthless.
PointResult measure(const Parameters& parameters, const State& start, const PointOptions& options, const std::function<bool()>& stop);

/// The state that a run of other parameters takes over: the same motion, the free mass at the same place of its cavity.
State carried(const State& state, const Parameters& from, const Parameters& to);

/// Calls task(0), ..., task(count - 1), each once, from so many threads, and returns when all are done. A task that
/// throws ends the work: the exception comes out of here once the other threads are back.
void parallel(std::size_t count, int threads, const std::function<void(std::size_t)>& task);

}  // namespace vines
