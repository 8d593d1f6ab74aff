// What is measured at one point of a sweep.
#pragma once

#include <functional>
#include <optional>

#include "core/analysis/analysis.hpp"

namespace vines {

/// Which points of the motion a sweep keeps for a bifurcation diagram.
enum class SectionKind { none, impact, stroboscopic };

struct PointOptions {
    double transient_cycles = 200;  ///< run before anything is measured; whole cycles
    double cycles = 1000;           ///< measured; whole cycles
    long max_impacts = 1000000;     ///< of the measured part; the transient has its own limit
    SectionKind section = SectionKind::none;
    std::size_t section_points = 200;  ///< the last so many
    double section_phase = 0;          ///< of a stroboscopic section: rad after each whole cycle
    /// Whether a neighbour goes on from the last state: PointResult::at_end.
    bool carry = false;
};

struct PointResult {
    /// False: the transient did not end, and nothing else here has a meaning.
    bool measured = false;
    /// Of the measured part, or of the transient where there is none; what it ended by.
    Outcome outcome;
    /// At a whole cycle at or behind the measured part's end; with PointOptions::carry.
    std::optional<State> at_end;
    Exponents lambda, standard_error;  ///< qr
    Verdict verdict;                   ///< of what the motion ends in
    Regime regime;                     ///< without its lists
    /// m, m, over that of the steady motion without the absorber (free: of the same start)
    double x_max, x_rms, x_rms_ratio;
    /// Steady amplitude without the absorber, m; none undamped at resonance.
    std::optional<double> x_free;
    std::optional<double> share_impacts;  ///< of the dissipated energy; none where nothing is
    long impacts, sticks;
    Sections sections;  ///< of the kind that was asked for
};

/// A transient may have so many impacts a cycle: far more than any motion has that is not a chatter
/// without end (R = 1).
inline constexpr long transient_impacts_per_cycle = 1000;

/// Runs one point from a state at tau = 0. `stop` as in Limits; once it says true the result is
/// worthless.
PointResult measure(
    const Parameters& parameters, const State& start, const PointOptions& options,
    const std::function<bool()>& stop);

/// The same run by run, for who does them together with others.
class PointRun {
public:
    PointRun(
        const Parameters& parameters, const State& start, const PointOptions& options,
        std::function<bool()> stop);

    /// The transient, the measured part, none: as RunLine::next().
    std::optional<RunPlan> next(const std::optional<Outcome>& last);
    /// Once there is none.
    PointResult take() { return std::move(result_); }

private:
    std::optional<RunPlan> measured_from(const State& begin);
    void conclude(const Outcome& outcome);

    const Parameters parameters_;
    const State start_;
    const PointOptions options_;
    const std::function<bool()> stop_;
    State begin_;  ///< of the measured part
    std::optional<AnalysisRun> analysis_;
    PointResult result_;
};

/// Whether two runs of the same point end in different motions, as far as this shows without a
/// doubt: only one without impacts, or different periods or impacts per period, or an rms of x that
/// differs by 1 % between periodic ones, by a fourth between others.
bool ends_elsewhere(const PointResult& one, const PointResult& other);

}  // namespace vines
