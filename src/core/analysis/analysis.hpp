// The room where a run is made: what is wanted of it goes in, what it came to comes out.
//
// One pass over the motion feeds the observers of all parts that are wanted; then each part is
// concluded, once, in the order of the result. Nobody else needs to wire observers to simulate().
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/analysis/impact_list.hpp"
#include "core/analysis/perturbation.hpp"
#include "core/analysis/warning.hpp"
#include "core/analysis/window_exponents.hpp"
#include "core/measures/energy.hpp"
#include "core/measures/manifold.hpp"

namespace vines {

/// Which parts of a run are wanted. What costs nothing (how it ended, its sticks) is always there.
struct Parts {
    bool series = false;
    bool impacts = false;     ///< listed, with tangent contacts
    bool exponents = false;   ///< of the window, with the verdict
    bool moduli = false;      ///< of the eigenvalues of J, M, T at each impact
    bool matrices = false;    ///< J, M, T
    bool section = false;     ///< at impact and stroboscopic
    bool energy = false;      ///< balance and amplitudes
    bool unattached = false;  ///< with energy: beside the oscillator alone
    bool regime = false;
    bool before_capture = false;  ///< with regime: the exponents before an orbit's capture, too
    bool manifold = false;
};

/// What is wanted of a run. Valid is what validate() finds no fault with, and a window that begins
/// before tau_end, and with a perturbation that validates as well.
struct Wanted {
    Parameters parameters;
    State start;
    double tau_end = 0;
    long max_impacts = 100000;
    /// What all parts but series and impacts refer to.
    Interval window = {0, tau_end};
    std::vector<Interval> windows = {};  ///< more, for the exponents of each
    Parts parts = {};
    ExponentOptions estimators = {};
    /// The difference of the start, of a second run that is compared with this one.
    std::optional<State> perturbation = {};
    double samples_per_cycle = 32;  ///< of the series, and of a perturbed one
    double section_phase = 0;       ///< of the stroboscopic section, rad after each whole cycle
    /// The longest series; of what is longer otherwise, the last so many entries.
    std::size_t most_points = everything;
    std::size_t most_listed = everything;  ///< the last so many impacts, sticks, touches
    /// Of more listed impacts than this none is kept: Analysis::unkept_impacts.
    std::size_t most_kept = everything;
};

/// What may end the work from outside: asked every few events. Empty: nothing.
struct Interrupt {
    std::function<bool()> run = {};   ///< ends the run; what follows is about what was reached
    std::function<bool()> late = {};  ///< ends what is concluded from it, where that takes long
};

/// J, M and T of the impacts, each in the order (x', x, y', y).
struct TransferMatrices {
    std::vector<double> tau;
    std::vector<Matrix4> J, M, T;
};

/// Moduli of their eigenvalues, descending.
struct TransferModuli {
    std::vector<double> tau;
    std::vector<Moduli> J, M, T;
    std::vector<double> M_condition;  ///< condition number of M
};

/// The motion on two surfaces: where it meets a wall, and at one phase of the forcing.
struct Sections {
    std::vector<SectionPoint> impact;
    std::vector<double> tau;    ///< of the stroboscopic states
    std::vector<State> states;  ///< stroboscopic
};

/// When the energy of a free decay falls to a half and to a tenth of what it was at the window's
/// start; none where the motion does not come to that.
struct DecayMoments {
    std::optional<double> half, tenth;
};

/// Where the energy went, and how the motion compares with that of the oscillator alone.
struct EnergyResult {
    EnergyBalance balance;
    std::optional<Unattached> unattached;
    std::optional<double> rms_ratio, peak_ratio;  ///< over those of the oscillator alone
    struct Decays {
        DecayMoments with_absorber, without;
    };
    std::optional<Decays> decay;  ///< of a free decay
};

/// The half cycles of a run beside the manifold that they may lie on.
struct ManifoldResult {
    std::optional<Manifold> manifold;  ///< none where the walls differ
    std::vector<double> tau;           ///< end of each half cycle
    std::vector<ManifoldPoint> points;
};

/// What a run came to. A part that is not wanted is empty, but for what another one rests on: the
/// regime and the exponents are there with each other and with windows, and impacts, with no
/// touches, where a section is wanted.
struct Analysis {
    Outcome outcome;
    Interval reached;  ///< what of the window the run has reached
    std::optional<Series> series;
    std::vector<Impact> impacts;
    /// In place of them, where they were too many to be kept: repeat_impacts() tells them.
    std::optional<ImpactRange> unkept_impacts;
    double typical_speed = 1;  ///< median of the impacts' relative speeds
    std::vector<StuckPhase> sticks;
    long stick_count = 0;  ///< of all, listed or not
    std::vector<TangentContact> touches;
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

Analysis analyse(const Wanted& wanted, const Interrupt& interrupt = {});

/// The same in two steps, for who runs the motion together with others.
class AnalysisRun {
public:
    AnalysisRun(const Wanted& wanted, const Interrupt& interrupt);
    ~AnalysisRun();

    /// What is to be run; its observers are in here.
    RunPlan plan();
    /// Once that has ended.
    Analysis conclude(const Outcome& outcome);

private:
    struct Observers;
    class Conclusion;
    const Wanted wanted_;
    const Interrupt interrupt_;
    const std::unique_ptr<Observers> observers_;
};

}  // namespace vines
