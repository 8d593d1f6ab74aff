// Warnings about a result, as data. The presentation layer turns them into sentences.
#pragma once

#include <cstddef>
#include <optional>
#include <variant>

namespace vines {

namespace warning {

/// The run ended before its window began.
struct WindowNotReached {
    double tau_start;
};
/// The series has fewer samples per cycle than requested, so that it keeps to most_points.
struct SeriesThinned {
    double samples_per_cycle, asked;
    std::size_t most;
};
/// A list was cut to its last entries.
struct ListCut {
    const char* name;  ///< impacts, touches, sticks, perturbed impacts
    long seen;
    std::size_t kept;
};
struct GrazingContact {};       ///< grazing contacts without an impact
struct RawProductOverflows {};  ///< the unscaled product of transfer matrices overflowed
/// The exponents by qr violate the sum rule by more than most_residual, per unit of tau.
struct SumRuleMissed {
    double tau_start, tau_end, residual;
};
struct NoExponents {};  ///< fewer than two impacts in the window
/// The product of transfer matrices lost rank: 2 after a sticking phase, 3 after R = 0.
struct RankLost {
    int rank;
};
/// Impacts with an ill-conditioned M: their count, the time of the one closest to grazing, and its
/// relative speed over the median of all.
struct NearlyTangent {
    long count;
    double tau, speed_ratio;
};
/// Transfer matrices are given for the last impacts only.
struct TransfersCut {
    std::size_t most;
    long seen;
};
/// Time allowed the eigenvalues of only the last `kept` impacts.
struct ModuliCut {
    std::size_t kept;
};
struct SectionsCut {
    std::size_t most;
    long impacts;
    std::size_t cycles;
};
struct StretchesCut {
    std::size_t seen, most;
};
struct OrbitSearchStopped {};  ///< the search for a periodic orbit was interrupted
/// A chaotic transient captured by an orbit: lambda1 before and after; the time of capture if it
/// lies in the run.
struct CapturedTransient {
    double before, after;
    std::optional<double> tau;
};
struct NoManifold {};  ///< R differs between the walls; the manifold assumes equal walls
/// The perturbed run ended before its reference: by max_impacts, or interrupted.
struct PerturbedRunCut {
    double tau;
    bool stopped;  ///< interrupted
};
/// The distance follows the linear theory over too few impacts to have a slope.
struct NoDistanceSlope {
    double linear_until;
    long impacts;
};

}  // namespace warning

using Warning = std::variant<
    warning::WindowNotReached, warning::SeriesThinned, warning::ListCut, warning::GrazingContact,
    warning::RawProductOverflows, warning::SumRuleMissed, warning::NoExponents, warning::RankLost,
    warning::NearlyTangent, warning::TransfersCut, warning::ModuliCut, warning::SectionsCut,
    warning::StretchesCut, warning::OrbitSearchStopped, warning::CapturedTransient,
    warning::NoManifold, warning::PerturbedRunCut, warning::NoDistanceSlope>;

}  // namespace vines
