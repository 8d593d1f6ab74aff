// analyse(): one run of the system and everything requested of it. One pass over the motion feeds
// the observers of all requested parts; then each part is concluded, in the order of the result.
#pragma once

#include <optional>
#include <variant>
#include <vector>

#include "core/analysis/perturbation.hpp"
#include "core/measures/energy.hpp"
#include "core/measures/extremes.hpp"
#include "core/measures/manifold.hpp"
#include "core/measures/regime.hpp"

namespace vines {

/// Parts of a result that are computed on request.
struct Parts {
    bool series = false;
    bool impacts = false;    ///< list of impacts, with grazing contacts
    bool exponents = false;  ///< of the window, with the verdict
    bool moduli = false;     ///< moduli of the eigenvalues of J, M, T at each impact
    bool matrices = false;   ///< the matrices themselves
    bool section = false;    ///< Poincare sections: at impact and stroboscopic
    bool energy = false;     ///< balance and amplitudes
    ExtremesWanted extremes = ExtremesWanted::none;
    bool unattached = false;  ///< with energy: comparison with the oscillator without absorber
    bool regime = false;
    bool before_capture = false;  ///< with regime: exponents before the capture by an orbit
    bool manifold = false;
};

/// Input of analyse(): validate() reports no fault; the window begins before tau_end.
struct AnalysisRequest {
    Parameters parameters;
    State start;
    double tau_end = 0;
    long max_impacts = 100000;
    Interval window = {0, tau_end};      ///< window of all parts except series and impacts
    std::vector<Interval> windows = {};  ///< further windows, for their exponents
    Parts parts = {};
    ExponentOptions estimators = {};
    /// Initial difference of a second run that is compared with this one.
    std::optional<State> perturbation = {};
    double settle_cycles = 0;       ///< how long a chaotic run is continued, see RegimeEvidence
    double samples_per_cycle = 32;  ///< of the series, also of the perturbed one
    double section_phase = 0;       ///< stroboscopic section: rad after each whole cycle
    /// Maximum length of the series, which is thinned; other lists keep their last entries.
    std::size_t most_points = everything;
    std::size_t most_listed = everything;  ///< of the lists of impacts, sticks, touches
    /// Impacts held in memory: if there are more, none is, and unkept_impacts describes them.
    std::size_t most_kept = everything;
};

/// Callbacks that end the work early, polled every few events. Empty: never.
struct Interrupt {
    StopRequest run = {};   ///< ends the run; the result describes the part that was reached
    StopRequest late = {};  ///< ends long computations after the run
};

/// Matrices of each impact for (x', x, y', y): J of the flight, M of the impact, T = M J.
struct TransferMatrices {
    std::vector<double> tau;
    std::vector<Matrix4> J, M, T;
};

/// Moduli of the eigenvalues of J, M and T, descending.
struct TransferModuli {
    std::vector<double> tau;
    std::vector<Moduli> J, M, T;
    std::vector<double> M_condition;  ///< condition number of M
};

/// The motion on two Poincare sections: |x - y| = b, and one phase of the forcing.
struct Sections {
    std::vector<SectionPoint> impact;
    std::vector<double> tau;    ///< of the stroboscopic states
    std::vector<State> states;  ///< stroboscopic
};

struct WindowExponents {
    Interval asked;
    TransferProduct product;  ///< with the requested estimators
    Growth growth;            ///< by qr; NaN without qr
    Judgement judgement;
};

struct EnergyResult {
    EnergyBalance balance;
    std::optional<Unattached> unattached;
    std::optional<double> rms_ratio, peak_ratio;  ///< with absorber over without
    double peak_least = nan;  ///< CyclePeaks::least(); as the ratios, only with Parts::unattached
    struct Decays {
        DecayTimes with_absorber, without;
    };
    std::optional<Decays> decay;  ///< free decay only
};

/// Half cycles (HalfCycles) and the slow invariant manifold.
struct ManifoldResult {
    std::optional<Manifold> manifold;  ///< empty without one constant R of both walls
    std::vector<double> tau;           ///< end of each half cycle
    std::vector<ManifoldPoint> points;
};

// Warnings about a result, as data; api/warning_text.cpp has their sentences. Where a list is cut,
// `seen` is its full length, `kept` and `most` the number of its last entries that remain.
namespace warning {

/// The run ended, at `tau`, before `count` of its windows began, the first at tau_start.
struct WindowNotReached {
    double tau, tau_start;
    std::size_t count;
};
/// The series was thinned to `most` points: it has samples_per_cycle instead of `asked`.
struct SeriesThinned {
    double samples_per_cycle, asked;
    std::size_t most;
};
struct ListCut {
    const char* name;  ///< impacts, touches, sticks, perturbed impacts
    long seen;
    std::size_t kept;
};
struct GrazingContact {};       ///< at least one grazing contact occurred
struct RawProductOverflows {};  ///< the unscaled product of transfer matrices overflowed
/// TransferProduct::sum_rule_residual() exceeds most_residual.
struct SumRuleMissed {
    double tau_start, tau_end, residual;
};
struct NoExponents {};  ///< fewer than two impacts in the window
struct RankLost {
    int rank;  ///< of the product of transfer matrices
};
/// Impacts close to grazing, where the saltation matrix M is ill-conditioned.
struct NearlyTangent {
    long count;
    double tau, speed_ratio;  ///< of the slowest one: its relative speed over the median
};
/// Transfer matrices are those of the last `most` of `seen` impacts.
struct TransfersCut {
    std::size_t most;
    long seen;
};
/// Interrupt::late: eigenvalue moduli are those of the last `kept` impacts.
struct ModuliCut {
    std::size_t kept;
};
/// The sections were cut to their last `most` points; `impacts` and `cycles` are the full counts.
struct SectionsCut {
    std::size_t most;
    long impacts;
    std::size_t cycles;
};
struct StretchesCut {
    std::size_t seen, most;  ///< synchronised intervals of the run; the last `most` are listed
};
struct OrbitSearchStopped {};  ///< the search for a periodic orbit was interrupted
/// A chaotic transient was captured by an orbit.
struct CapturedTransient {
    double before, after;       ///< lambda1 before and after the capture
    std::optional<double> tau;  ///< of the capture
    bool in_run;                ///< it happened within the run
};
/// The means of a window, lambda1 or x_rms, differ between its halves by more than chance permits:
/// standard errors do not cover. `conservative`: without dissipation the energy drifts.
struct NotStationary {
    bool lambda1, x_rms, conservative;
};
struct NoManifold {};  ///< the manifold assumes one constant R of both walls
/// The perturbed run ended before its reference, because it reached max_impacts or was interrupted.
struct PerturbedRunCut {
    double tau;
    bool stopped;  ///< interrupted
};
/// The distance follows the linear theory over too few impacts to have a slope.
struct NoDistanceSlope {
    double linear_until;  ///< tau
    long impacts;
};

}  // namespace warning

using Warning = std::variant<
    warning::WindowNotReached, warning::SeriesThinned, warning::ListCut, warning::GrazingContact,
    warning::RawProductOverflows, warning::SumRuleMissed, warning::NoExponents, warning::RankLost,
    warning::NearlyTangent, warning::TransfersCut, warning::ModuliCut, warning::SectionsCut,
    warning::StretchesCut, warning::OrbitSearchStopped, warning::CapturedTransient,
    warning::NotStationary, warning::NoManifold, warning::PerturbedRunCut,
    warning::NoDistanceSlope>;

/// Appends the warnings about a product; without `histories` only the violation of the sum rule.
void add_warnings(const TransferProduct& product, bool histories, std::vector<Warning>& warnings);

/// Result of analyse(). Parts that were not requested are empty, but regime, exponents and windows
/// come together, and a section brings the impacts (without touches).
struct Analysis {
    Outcome outcome;
    Interval reached;  ///< the part of the window that the run reached
    std::optional<Series> series;
    std::vector<Impact> impacts;
    /// Set instead of `impacts` if these are too many to keep: repeat_impacts() recomputes them.
    std::optional<ImpactRange> unkept_impacts;
    double typical_speed = 1;  ///< median of the impacts' relative speeds
    std::vector<StickingPhase> sticks;
    std::vector<ContactEvent> touches;
    std::optional<WindowExponents> exponents;
    std::vector<WindowExponents> windows;
    std::optional<TransferModuli> moduli;
    std::optional<TransferMatrices> matrices;
    std::optional<Sections> sections;
    std::optional<EnergyResult> energy;
    Extremes extremes;  ///< zero unless requested
    std::optional<Regime> regime;
    std::optional<ManifoldResult> manifold;
    std::optional<Perturbation> perturbation;
    std::vector<Warning> warnings;
};

/// Impacts for which memory is reserved: four per cycle, which few motions exceed.
std::size_t impacts_expected(const AnalysisRequest& wanted);

Analysis analyse(const AnalysisRequest& wanted, const Interrupt& interrupt = {});

}  // namespace vines
