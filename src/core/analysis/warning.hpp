// What a user should know beside the numbers of a result, as data: whoever shows it finds the
// words.
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
/// A smaller number of samples than asked for, so that the series keeps to most_points.
struct SeriesThinned {
    double samples_per_cycle, asked;
    std::size_t most;
};
/// Of a list only its last entries are kept.
struct ListCut {
    const char* name;  ///< impacts, touches, sticks, perturbed impacts
    long seen;
    std::size_t kept;
};
/// Tangent contacts without an impact.
struct Touched {};
/// The unscaled product has left the range of double.
struct RawProductOverflows {};
/// The exponents of qr miss the sum rule by more than most_residual, per unit of tau.
struct SumRuleMissed {
    double tau_start, tau_end, residual;
};
/// Fewer than two impacts in the window.
struct NoExponents {};
/// The product lost rank: at 2 by a stick, at 3 by R = 0.
struct RankLost {
    int rank;
};
/// Impacts at which M is ill-conditioned; of the most nearly tangent one its moment, and its
/// relative speed over the median of all.
struct NearlyTangent {
    long count;
    double tau, speed_ratio;
};
/// Transfer matrices are kept of the last impacts only.
struct TransfersCut {
    std::size_t most;
    long seen;
};
/// There was time for the eigenvalues of so many impacts only.
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
/// The search for a periodic orbit was ended from outside.
struct OrbitSearchStopped {};
/// A chaotic transient that an orbit captured: lambda1 of both, and when, if that was in the run.
struct CapturedTransient {
    double before, after;
    std::optional<double> tau;
};
/// The walls differ, and the manifold is that of two equal ones.
struct NoManifold {};
/// The perturbed run ended before its reference: by max_impacts, or from outside.
struct PerturbedRunCut {
    double tau;
    bool stopped;  ///< from outside
};
/// Of a distance that follows the linear theory over too few impacts to have a slope.
struct NoDistanceSlope {
    double linear_until;
    long impacts;
};

}  // namespace warning

using Warning = std::variant<
    warning::WindowNotReached, warning::SeriesThinned, warning::ListCut, warning::Touched,
    warning::RawProductOverflows, warning::SumRuleMissed, warning::NoExponents, warning::RankLost,
    warning::NearlyTangent, warning::TransfersCut, warning::ModuliCut, warning::SectionsCut,
    warning::StretchesCut, warning::OrbitSearchStopped, warning::CapturedTransient,
    warning::NoManifold, warning::PerturbedRunCut, warning::NoDistanceSlope>;

}  // namespace vines
