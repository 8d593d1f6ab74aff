// analyse(): one run of the system and everything requested of it.
//
// One pass over the motion feeds the observers of all requested parts; then each part is concluded
// once, in the order of the result. Callers never connect observers to simulate() themselves.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/analysis/impact_collector.hpp"
#include "core/analysis/perturbation.hpp"
#include "core/analysis/warning.hpp"
#include "core/measures/energy.hpp"
#include "core/measures/manifold.hpp"
#include "core/measures/regime.hpp"

namespace vines {

/// Parts of a result that are computed on request. The end of the run and the number of sticking
/// phases cost nothing and are always computed.
struct Parts {
    bool series = false;
    bool impacts = false;     ///< list of impacts, with grazing contacts
    bool exponents = false;   ///< of the window, with the verdict
    bool moduli = false;      ///< moduli of the eigenvalues of J, M, T at each impact
    bool matrices = false;    ///< the matrices themselves
    bool section = false;     ///< Poincare sections: at impact and stroboscopic
    bool energy = false;      ///< balance and amplitudes
    bool unattached = false;  ///< with energy: comparison with the oscillator without absorber
    bool regime = false;
    bool before_capture = false;  ///< with regime: exponents before the capture by an orbit
    bool manifold = false;
};

/// Input of analyse(). Requires: validate() reports no fault for parameters, start and perturbed
/// start; the window begins before tau_end.
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
    double samples_per_cycle = 32;  ///< of the series, also of the perturbed one
    double section_phase = 0;       ///< stroboscopic section: rad after each whole cycle
    /// Maximum length of the series, which is thinned; other lists keep their last entries.
    std::size_t most_points = everything;
    /// Maximum length of the lists of impacts, sticks, touches.
    std::size_t most_listed = everything;
    /// Longest list of impacts kept in memory; a longer one is described by unkept_impacts.
    std::size_t most_kept = everything;
};

/// Callbacks that end the work early, polled every few events. Empty: never.
struct Interrupt {
    /// Ends the run; the result describes the part that was reached.
    std::function<bool()> run = {};
    std::function<bool()> late = {};  ///< ends the conclusions that take long
};

/// Matrices J, M and T of each impact, in the state order (x', x, y', y).
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

/// Times at which the energy of a free decay falls to a half and to a tenth of its value at the
/// window's start; empty if the motion does not get there.
struct DecayTimes {
    std::optional<double> half, tenth;
};

/// coarse_slope() of each estimator, per unit of tau; NaN if the estimator was not requested or has
/// too few impacts.
struct ExponentSlopes {
    double qr, eigenvalues, raw_product;
};

struct WindowExponents {
    Interval asked;
    TransferProduct product;  ///< with the requested estimators
    Growth growth;            ///< by qr; NaN without qr
    ExponentSlopes slopes;
    Judgement judgement;
};

/// Verdict and slopes of a window. `growth` belongs to the product, `regime` to the run.
WindowExponents window_exponents(
    const Interval& window, TransferProduct&& product, const Growth& growth, const Regime& regime);

/// Appends the warnings about a product. If `histories` are requested: all; otherwise only the
/// violation of the sum rule.
void add_warnings(
    const TransferProduct& product, const ExponentOptions& requested, bool histories,
    std::vector<Warning>& warnings);

struct EnergyResult {
    EnergyBalance balance;
    std::optional<Unattached> unattached;
    std::optional<double> rms_ratio, peak_ratio;  ///< with absorber over without
    struct Decays {
        DecayTimes with_absorber, without;
    };
    std::optional<Decays> decay;  ///< free decay only
};

/// Half cycles of a run as points (C, V), to be compared with the slow invariant manifold.
struct ManifoldResult {
    std::optional<Manifold> manifold;  ///< empty if R differs between the walls
    std::vector<double> tau;           ///< end of each half cycle
    std::vector<ManifoldPoint> points;
};

/// Result of analyse(). Parts that were not requested are empty, with these exceptions: regime and
/// exponents always come together, also with windows; a section comes with the impacts, but without
/// touches.
struct Analysis {
    Outcome outcome;
    Interval reached;  ///< the part of the window that the run reached
    std::optional<Series> series;
    std::vector<Impact> impacts;
    /// Set instead of `impacts` if these are too many to keep: repeat_impacts() recomputes them.
    std::optional<ImpactRange> unkept_impacts;
    double typical_speed = 1;  ///< median of the impacts' relative speeds
    std::vector<StickingPhase> sticks;
    long stick_count = 0;  ///< including those that are not listed
    std::vector<GrazingEvent> touches;
    std::optional<WindowExponents> exponents;
    std::vector<WindowExponents> windows;
    std::optional<TransferModuli> moduli;
    std::optional<TransferMatrices> matrices;
    std::optional<Sections> sections;
    std::optional<EnergyResult> energy;
    std::optional<Regime> regime;
    std::optional<ManifoldResult> manifold;
    std::optional<Perturbation> perturbation;
    std::vector<Warning> warnings;
};

Analysis analyse(const AnalysisRequest& wanted, const Interrupt& interrupt = {});

/// analyse() in two steps, for callers that run several motions as a batch (simulate_batch()).
class AnalysisRun {
public:
    AnalysisRun(const AnalysisRequest& wanted, const Interrupt& interrupt);
    ~AnalysisRun();

    /// The run, with this object's observers; valid while the object lives.
    RunPlan plan();
    Analysis conclude(const Outcome& outcome);

private:
    struct Observers;
    class Conclusion;
    const AnalysisRequest wanted_;
    const Interrupt interrupt_;
    const std::unique_ptr<Observers> observers_;
};

}  // namespace vines
