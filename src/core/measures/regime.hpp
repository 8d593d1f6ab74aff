// Response regimes I to VI (section 4 of the paper), their evidence, and the verdict chaotic or
// regular. A response is periodic if an attracting orbit (stability/orbit.hpp) is found near the
// end of the run: its contacts per cycle and its symmetry give the type. Other responses are
// classified by contacts per cycle and by the longest synchronised stretch (rhythm.hpp); one whose
// section is a smooth closed curve (torus.hpp) is quasi-periodic.
#pragma once

#include <optional>

#include "core/measures/rhythm.hpp"
#include "core/measures/torus.hpp"
#include "core/motion/record.hpp"
#include "core/stability/orbit.hpp"
#include "core/stability/verdict.hpp"

namespace vines {

/// Response types. none: no impact, or no harmonic forcing. Not periodic: I sparse, II with
/// stretches of two impacts per cycle, VI others. Periodic: III two symmetric impacts per cycle, IV
/// two asymmetric ones, V others.
enum class RegimeType { none, I, II, III, IV, V, VI };

/// Capture of a run by the periodic orbit that attracts it.
struct Capture {
    /// Time from which the run stays near the orbit without chaos (later if time ran out); after
    /// the run's end if the run was continued. Empty if the run ends on its way to the orbit.
    std::optional<double> tau;
    Exponents after;  ///< from the Floquet multipliers
    /// Exponents by qr from the first impact to tau or to the end; NaN if too few impacts or not
    /// examined.
    Exponents before = no_exponents;
    /// Chaos before is shown, by its exponents or a part of their history.
    std::optional<bool> chaotic_before = {};
};

struct Regime : ContactCounts {
    RegimeType type = RegimeType::none;
    bool forced = true;      ///< false for a free decay (G = 0), which has no regime
    bool has_period = true;  ///< false for a recorded load, which has neither orbit nor type
    /// Contacts per forcing cycle: of the orbit if periodic, else z_overall.
    double z = 0;
    std::optional<PeriodicOrbit> orbit;           ///< the stable orbit that the run approaches
    std::optional<Capture> capture;               ///< set together with orbit
    std::optional<QuasiPeriodic> quasi_periodic;  ///< only without an orbit
    /// Contacts in each cycle, if all cycles have the same number of them.
    std::optional<int> in_every_cycle;
    struct Untouched {
        /// Proven: the ball rests and the oscillator cannot reach it, or friction holds it.
        bool for_ever;
        double y_dot;                        ///< velocity of the ball
        bool held;                           ///< friction holds the ball now
        std::optional<double> next_contact;  ///< tau; empty if it is later than 10,000 cycles
    };
    std::optional<Untouched> untouched;  ///< end of a run without contacts in its window
    long followed = 0;  ///< cycles by which a chaotic run was continued without being captured
    bool search_stopped = false;  ///< RegimeEvidence::stop ended the search for an orbit
};

// Longest period that is searched for, cycles.
inline constexpr std::size_t longest_period = 512;
/// States at the run's end that the search for an orbit needs, including one before them.
inline constexpr std::size_t fewest_states = longest_period + 2;
/// States kept of a run (2 MB). If the capture was earlier, the run is repeated to date it.
inline constexpr std::size_t kept_states = 1 << 16;

struct RegimeEvidence {
    Rhythm& rhythm;  ///< of the window; regime_of() calls its finish()
    /// From tau = 0 to the window's end, or at least its last fewest_states states.
    const StroboscopicRecord& stroboscopic;
    double tau_start, tau_end;  ///< the window; tau_end lies within the run
    /// If chaotic, a run that is not periodic yet is not continued.
    Verdict by_exponents = Verdict::not_decided;
    /// The exponents permit a quasi-periodic motion (can_be_quasi_periodic()).
    bool neutral = false;
    double settle_cycles =
        0;                  ///< longest continuation of a chaotic run, to find out where it settles
    StopRequest stop = {};  ///< ends the search for an orbit, see Limits::stop
};

/// Regime of a run. With `exponents_before` also the exponents before a capture, which repeats the
/// run up to there; otherwise, or if time ran out, they are NaN.
Regime regime_of(
    const Parameters& parameters, const State& start, const RegimeEvidence& evidence,
    bool exponents_before = true);

/// True if the ball rests at this state at a whole cycle and the oscillator can never reach it.
bool is_never_touched(const Parameters& parameters, const State& at_whole_cycle);

/// Reason for a verdict.
enum class VerdictReason {
    growth,    ///< chaotic: by the window's own exponents
    on_orbit,  ///< regular: the window begins on the stable orbit
    /// Regular: the motion settles on a stable orbit and was not chaotic before.
    settling,
    quasi_periodic,  ///< regular: the motion is on a torus
    free_decay,      ///< none: no forcing, so the motion dies out
    untouched,       ///< none: the motion ends without impacts
    next_contact,    ///< not decided: no impacts in the window, but not for ever
    /// Not decided: the window holds both a chaotic transient and the orbit that captured it.
    transient,
    /// Not decided: time ran out before the part before a capture could be examined.
    not_known_before,
    no_error,          ///< not decided: too few impacts for a standard error
    within_error,      ///< not decided: lambda1 lies within its error
    little_growth,     ///< not decided: departure from one unstable orbit could grow as much
    algebraic_growth,  ///< not decided: the growth slows down as it does near a torus
    negative,          ///< not decided: lambda1 is negative, but no stable orbit was found
};
struct Judgement {
    Verdict verdict;
    VerdictReason reason;
};

/// Verdict on a window, from the window's own exponents and from the regime of the run.
Judgement judge(const Growth& growth, const Regime& regime, double tau_start);

const char* name_of(RegimeType type);

}  // namespace vines
