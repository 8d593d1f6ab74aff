// Lyapunov exponents of a sequence of impacts with gaps.
//
// Transfer matrices are known only where every impact is known, in stretches. `qr` adds the growth
// over all stretches and divides by their total duration; the deviations are carried across gaps,
// because the growing directions change little from impact to impact (docs/numerics.md). No matrix
// product across a gap exists: `eigenvalues` and `raw_product` use the longest stretch.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/measurement/hidden_contacts.hpp"
#include "core/measurement/unknowns.hpp"
#include "core/stability/lyapunov.hpp"
#include "core/stability/verdict.hpp"

namespace vines {

/// Growth rate of a measured sum of logarithms in the long run, with a confidence interval.
/// The growth follows the amplitude modulation of the oscillator, so that of a short record depends
/// on the slow state at both ends: this part is fitted to the growth over about half a modulation
/// and subtracted. The correlation of the remaining steps follows from their spectrum at zero.
struct MeasuredSlope {
    double value;      ///< per unit of tau
    double low, high;  ///< 90 % interval; NaN with too few steps
};

/// From one impact to another (indices), with all flights between them known.
struct KnownStretch {
    std::size_t first, last;
};

struct Continuity {
    std::vector<KnownStretch> stretches;  ///< of at least two impacts
    long left_out = 0;                    ///< impacts with a fault
    /// Flights between two good impacts that do not fit or cross a gap.
    long missing = 0;
    double share = 0;  ///< fraction left out or missing, of all impacts including the missing ones

    /// Above this fraction the rest is not representative of the motion.
    static constexpr double most = 0.05;
    /// Whether too many impacts are excluded or missing for a verdict.
    bool is_incomplete() const { return share > most; }
};
/// Only gaps longer than a tenth of a typical flight count: an impact could hide in them.
Continuity continuity_of(
    const Parameters& parameters, const IdentifiedImpacts& impacts, std::vector<Interval> gaps);

class MeasuredExponents {
public:
    /// `values`: stiffness and damping of the oscillator, in tau of the given omega0. `system`: of
    /// a sliding ball, whose reversals and rests between impacts follow from runs; null without
    /// friction.
    MeasuredExponents(
        const Parameters& parameters, const UnknownValues& values, const IdentifiedImpacts& impacts,
        const std::vector<KnownStretch>& stretches, const ExponentOptions& options,
        const IdentifiedSystem* system = nullptr);

    /// The oscillator's own damping, per unit of tau.
    double zeta() const { return zeta_; }
    /// `qr` over all stretches; its clock stops between stretches.
    const TransferProduct& all() const { return all_; }
    /// `eigenvalues` and `raw_product` of the longest stretch.
    const TransferProduct& longest() const { return longest_; }
    /// Record time at which the clock of all() showed `clock`.
    double moment(double clock) const;
    /// Slope of the sum of logarithms of qr's first exponent, without its first tenth. The result
    /// does not depend on the requested length of the history.
    MeasuredSlope slope() const;

private:
    /// Slow state of the oscillator: (x, x') rotated back by the forcing's angle, divided by a
    /// typical amplitude. It hardly changes during a cycle.
    using SlowState = Eigen::Vector2d;
    struct StretchStart {
        double clock, tau;
    };
    /// State at an impact; unchanged across a gap, like the clock.
    struct SlowAt {
        double clock;
        SlowState state;
    };
    double zeta_;
    TransferProduct all_, longest_;
    std::vector<StretchStart> starts_;
    std::vector<SlowAt> slow_;
};

/// Conclusions from the growth of deviations.
struct IdentifiedExponents {
    MeasuredSlope slope;
    /// Chaotic if slope.low exceeds zeta; regular if slope.high is below it and impacts suffice.
    Verdict verdict;
    bool weakens = false;  ///< not decided for this reason, although forced
};
/// Whether the largest jump falls from quarter to quarter of the record, to less than half overall.
/// An unforced motion then dies out; a forced one can be in a transient or in the falling part of a
/// modulation. In windows of 30 impacts of Table 4's system at b = 15, 18 and 22 mm 80 of 677
/// weaken.
bool weakens(const IdentifiedImpacts& impacts);
/// `impacts`: those of the exponents.
IdentifiedExponents judge_exponents(
    const MeasuredExponents& exponents, const IdentifiedImpacts& impacts);

}  // namespace vines
