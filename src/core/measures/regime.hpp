// Response regimes I to VI (section 4 of the paper) with the evidence for each.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/measures/rhythm.hpp"
#include "core/motion/record.hpp"
#include "core/stability/orbit.hpp"
#include "core/stability/verdict.hpp"

namespace vines {

/// none: no impact at all, or no forcing. I: sparse, irregular. II: strongly modulated, stretches
/// of two impacts per cycle between others. III: two symmetric impacts per cycle, periodic. IV: two
/// asymmetric ones, periodic. V: any other periodic response. VI: any other irregular response.
enum class RegimeType { none, I, II, III, IV, V, VI };

/// How a run comes to the periodic orbit that attracts it.
struct Capture {
    /// From when on it stays next to it, or later where the time to look was over; none: it ends
    /// before that, and following it further showed where it goes.
    std::optional<double> tau;
    /// By qr, from the run's first impact to tau, or to its end; NaN where there is too little.
    Exponents before;
    Exponents after;  ///< from the Floquet multipliers
    /// By verdict_by_exponents(): the run was chaotic and then captured, not just settling; none:
    /// not known.
    std::optional<bool> chaotic_before;
};

struct Regime {
    RegimeType type = RegimeType::none;
    /// False for a free decay (G = 0), which is none of the regimes.
    bool forced = true;
    long contacts = 0;  ///< in the window
    /// Contacts per forcing cycle: of the orbit if periodic, else from the first to the last.
    double z = 0;
    double z_overall = 0;  ///< from the first to the last, in any case
    // Lists, as far as RegimeEvidence::rhythm makes them.
    std::vector<double> moving_tau, moving_z;  ///< over 10 cycles around tau
    std::vector<double> cycles_with;           ///< share of cycles with 0, 1, 2, ... contacts
    std::vector<SynchronyStretch> stretches;   ///< the last of them
    long stretch_count = 0;                    ///< of all
    double synchronised = 0;                   ///< share of the contacts in synchronised stretches
    long longest_synchronised = 0;             ///< half cycles of the longest
    std::optional<PeriodicOrbit> orbit;        ///< the stable orbit that the run has come to
    std::optional<Capture> capture;            ///< with it
    /// The search for an orbit was ended by RegimeEvidence::stop.
    bool search_stopped = false;
};

// A period that the run may have closed: in cycles.
inline constexpr std::size_t longest_period = 512;
/// The search for an orbit looks at so many states of the run's end, and one before them.
inline constexpr std::size_t fewest_states = longest_period + 2;
/// So many are kept of a run: 2 MB. What an orbit captured earlier is run once more to find out
/// when.
inline constexpr std::size_t kept_states = 1 << 16;

/// What a run must have been observed by.
struct RegimeEvidence {
    Rhythm& rhythm;  ///< of the window; regime_of() finishes it
    /// From tau = 0 to the window's end, or of that the last fewest_states or more.
    const StroboscopicRecord& stroboscopic;
    double tau_start, tau_end;  ///< the window to be judged; tau_end within the run
    /// Chaotic: a run that is not periodic yet is not followed further.
    Verdict by_exponents = Verdict::not_decided;
    std::function<bool()> stop = {};  ///< as in Limits: ends the search for an orbit
};

/// `exponents_before`: also those before a capture, for which the run is repeated up to there;
/// else, or where the time for it was over, they are NaN.
Regime regime_of(
    const Parameters& parameters, const State& start, const RegimeEvidence& evidence,
    bool exponents_before = true);

/// What a verdict rests on.
enum class VerdictReason {
    growth,    ///< chaotic: by the window's own exponents
    on_orbit,  ///< regular: the window begins on the stable orbit
    /// Regular: the motion settles on a stable orbit, which it was not chaotic before.
    settling,
    free_decay,  ///< none: no forcing, so the motion dies out
    untouched,   ///< none: the motion ends without impacts
    /// Not decided: a chaotic transient and the orbit that captured it share the window.
    transient,
    /// Not decided: an orbit captured the motion, but there was no time to look at what came
    /// before.
    not_known_before,
    no_error,          ///< not decided: too few impacts for a standard error
    within_error,      ///< not decided: lambda1 lies within its error
    little_growth,     ///< not decided: leaving one unstable orbit could grow as much
    algebraic_growth,  ///< not decided: the growth slows down as that beside a torus does
    negative,          ///< not decided: lambda1 is negative, but no stable orbit was found
};
struct Judgement {
    Verdict verdict;
    VerdictReason reason;
};

/// The verdict on a window of a run, from the window's own exponents and from where the run went.
Judgement judge(const Growth& growth, const Regime& regime, double tau_start);

const char* name_of(RegimeType type);

}  // namespace vines
