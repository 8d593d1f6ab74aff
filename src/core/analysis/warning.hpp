// Warnings about a result, as data. The presentation layer turns them into sentences. Times are
// dimensionless (tau). Where a list is cut, `seen` (or the named count) is its full length; `kept`
// and `most` are the number of its last entries that remain.
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
/// The series was thinned to most_points (`most`): it has samples_per_cycle, `asked` is the
/// requested density.
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
struct GrazingContact {};       ///< at least one grazing contact occurred
struct RawProductOverflows {};  ///< the unscaled product of transfer matrices overflowed
/// The exponents by qr violate the sum rule or a related check by `residual` > most_residual, per
/// unit of tau (TransferProduct::sum_rule_residual()).
struct SumRuleMissed {
    double tau_start, tau_end, residual;
};
struct NoExponents {};  ///< fewer than two impacts in the window
/// The product of transfer matrices is singular. `rank`: the remaining rank, 2 after a sticking
/// phase, 3 after an impact with R = 0.
struct RankLost {
    int rank;
};
/// Impacts close to grazing, where the saltation matrix M is ill-conditioned. `tau` and
/// `speed_ratio` describe the slowest one: its time, and its relative speed divided by the median
/// of all impacts.
struct NearlyTangent {
    long count;
    double tau, speed_ratio;
};
/// Transfer matrices are given for the last `most` of `seen` impacts only.
struct TransfersCut {
    std::size_t most;
    long seen;
};
/// The time limit was reached: eigenvalue moduli are given for the last `kept` impacts only.
struct ModuliCut {
    std::size_t kept;
};
/// The Poincare sections at impacts and at whole cycles were cut to their last `most` points;
/// `impacts` and `cycles` are the full counts.
struct SectionsCut {
    std::size_t most;
    long impacts;
    std::size_t cycles;
};
/// The list of stretches (synchronised parts of the run) was cut to its last `most` entries.
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
/// The perturbed run ended before its reference, because it reached max_impacts or was interrupted.
struct PerturbedRunCut {
    double tau;
    bool stopped;  ///< interrupted
};
/// The distance follows the linear theory, up to tau = linear_until, over too few impacts to have a
/// slope. `impacts`: their number.
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
