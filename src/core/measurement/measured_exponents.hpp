// Exponents of a sequence of impacts with gaps in it.
//
// The transfer matrix of a stretch is only known where each impact in it is. So the impacts fall
// into stretches that are known throughout. `qr` adds up the growth of the deviations over them and
// divides by the time that they last together; they are carried over a gap, for along the
// motion the growing directions change little from impact to impact. (With 10 % of the impacts
// lost, lambda1 comes out 2 % smaller; started anew behind each gap, 50 % larger.) A product over a
// gap does not exist: `eigenvalues` and `raw_product` are of the longest stretch.
#pragma once

#include <vector>

#include "core/measurement/identified_impact.hpp"
#include "core/measurement/measured_record.hpp"
#include "core/measurement/measured_slope.hpp"
#include "core/stability/verdict.hpp"

namespace vines {

/// From an impact to another, by their indices, with every flight between known.
struct KnownStretch {
    std::size_t first, last;
};

struct Continuity {
    std::vector<KnownStretch> stretches;  ///< of two impacts or more
    long left_out = 0;                    ///< impacts with a fault
    /// Flights between two others that do not fit, or over a gap of the record.
    long missing = 0;
    double share = 0;  ///< of both, of all impacts with the missing ones

    /// With more of them the rest is no fair sample of the motion.
    static constexpr double most = 0.05;
};
/// A gap is one where an impact could hide: longer than a tenth of a typical flight.
Continuity continuity_of(
    const Parameters& parameters, const std::vector<IdentifiedImpact>& impacts,
    const std::vector<TimeGap>& gaps);

/// Of the estimators that are asked for those of all stretches, and those of the longest alone.
ExponentOptions of_all_stretches(const ExponentOptions& asked);
ExponentOptions of_longest_stretch(const ExponentOptions& asked);

/// The oscillator between impacts, in the tau of the omega0 that was given: x'' + damping x' +
/// stiffness x is the forcing.
struct MeasuredOscillator {
    double stiffness, damping;

    /// As the parameters have it.
    static MeasuredOscillator given(const Parameters& p) { return {1, 2 * p.zeta()}; }
    double zeta() const { return 0.5 * damping; }  ///< per unit of tau
};

class MeasuredExponents {
public:
    MeasuredExponents(
        const Parameters& parameters, const MeasuredOscillator& oscillator,
        const std::vector<IdentifiedImpact>& impacts, const std::vector<KnownStretch>& stretches,
        const ExponentOptions& options);

    /// `qr` alone, of all stretches, on a clock that stands still outside of them.
    const TransferProduct& all() const { return all_; }
    /// `eigenvalues` and `raw_product`, of the longest stretch.
    const TransferProduct& longest() const { return longest_; }
    /// The moment of the record at which the clock of all() showed this.
    double moment(double clock) const;
    /// What the sum of logarithms of qr's first exponent grows by.
    MeasuredSlope slope() const;

private:
    struct Start {
        double clock, tau;
    };
    /// At an impact; it stands still over a gap, as the clock does.
    struct Slow {
        double clock;
        SlowState state;
    };
    TransferProduct all_, longest_;
    std::vector<Start> starts_;
    std::vector<Slow> slow_;
};

/// What the growth of deviations says.
struct IdentifiedExponents {
    MeasuredSlope slope;
    /// Chaotic: slope.low is above the oscillator's own damping zeta; regular: slope.high is below
    /// it, of a representative record.
    Verdict verdict;
    bool weakens = false;  ///< not decided for that, though it is forced
};
/// Whether a slope below zeta can be said of the motion, and not of a stretch in which a chaotic
/// one is in step. Of windows of 100 impacts of Table 4's system at b = 11 mm 142 of 506 look
/// regular, of 150 still 2 of 335, of 170 and more none. But in none of 80 are the jumps of the
/// second half alike to 2 %, in none of 150 to 9 %, as those of a periodic motion soon are: nine in
/// ten of them, against the typical jump at their wall. (Six b from 10.8 to 13 mm, some 30,000
/// windows of 80 to 200 impacts.)
bool is_representative(const std::vector<IdentifiedImpact>& impacts);
/// Whether from quarter to quarter of the impacts' time the largest jump falls, to less than half
/// in all. Without forcing the motion dies out then; a forced one may be in a transient, or in the
/// falling part of a modulation. Of windows of 30 impacts of Table 4's system at b = 15, 18 and 22
/// mm 80 of 677 weaken.
bool weakens(const std::vector<IdentifiedImpact>& impacts);
/// Whether the forcing is none, or too weak to keep up the motion that the last quarter of the
/// impacts shows.
bool is_unforced(const Parameters& parameters, const std::vector<IdentifiedImpact>& impacts);
IdentifiedExponents judge_exponents(
    const MeasuredOscillator& oscillator, const MeasuredExponents& exponents, bool representative);

}  // namespace vines
