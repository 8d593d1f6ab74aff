#include "api/warning_text.hpp"

#include <fmt/format.h>

#include "core/analysis/perturbation.hpp"

namespace vines::api {

namespace {

using namespace warning;

struct Sentence {
    std::size_t most_bytes;

    std::string operator()(const WindowNotReached& w) const {
        return fmt::format("the run ended before its window began at tau = {:.6g}", w.tau_start);
    }
    std::string operator()(const SeriesThinned& w) const {
        return fmt::format(
            "the series has {:.4g} samples per cycle instead of {:.4g}, so that it holds no more "
            "than max_points = {}",
            w.samples_per_cycle, w.asked, w.most);
    }
    std::string operator()(const ListCut& w) const {
        return fmt::format("of {} {} the last {} are listed", w.seen, w.name, w.kept) +
               limit_of(most_bytes);
    }
    std::string operator()(const Touched&) const {
        return "the mass touches a wall without an impact (tangent contact): neighbouring "
               "trajectories go different ways there";
    }
    std::string operator()(const RawProductOverflows&) const {
        return "raw_product overflows in this window: the unscaled product leaves the range of "
               "double near T = 709/lambda1";
    }
    std::string operator()(const SumRuleMissed& w) const {
        return fmt::format(
            "the exponents of qr in [{:.6g}, {:.6g}] miss the sum rule by {:.2g}: those that "
            "rounding has reached are not_converged",
            w.tau_start, w.tau_end, w.residual);
    }
    std::string operator()(const NoExponents&) const {
        return "there are fewer than two impacts in the window, so there are no exponents";
    }
    std::string operator()(const RankLost& w) const {
        return w.rank == 2 ? "a stick falls in the window: only deviations of the centre of mass "
                             "survive it, lambda3 and lambda4 are minus infinity"
                           : "R = 0 removes every deviation of x - y at its impacts: lambda4 is "
                             "minus infinity";
    }
    std::string operator()(const NearlyTangent& w) const {
        return fmt::format(
            "M is ill-conditioned at {} nearly tangent impact(s), most at tau = {:.6g}, whose "
            "relative speed is {:.2g} of the median: there the motion is next to one without this "
            "impact",
            w.count, w.tau, w.speed_ratio);
    }
    std::string operator()(const TransfersCut& w) const {
        return fmt::format(
            "eigenvalues and matrices are those of the last {} impacts (max_points) of {}", w.most,
            w.seen);
    }
    std::string operator()(const ModuliCut& w) const {
        return fmt::format(
            "eigenvalues are those of the last {} impacts: the time limit was over before those of "
            "the others",
            w.kept);
    }
    std::string operator()(const SectionsCut& w) const {
        return fmt::format(
            "the sections hold their last {} points (max_points), of {} impacts and {} cycles",
            w.most, w.impacts, w.cycles);
    }
    std::string operator()(const StretchesCut& w) const {
        return fmt::format("of {} stretches the last {} are listed (max_points)", w.seen, w.most);
    }
    std::string operator()(const OrbitSearchStopped&) const {
        return "the search for a periodic orbit was ended by the time limit: periodic is not "
               "decided";
    }
    std::string operator()(const CapturedTransient& w) const {
        return fmt::format(
            "a chaotic transient (lambda1 = {:.3g}) was captured by a periodic orbit {} (lambda1 = "
            "{:.3g}): exponents of a window that reaches over it average both",
            w.before, w.tau ? fmt::format("at tau = {:.1f}", *w.tau) : "after the run's end",
            w.after);
    }
    std::string operator()(const NoManifold&) const {
        return "the manifold of two symmetric impacts needs the same R at both walls: only the "
               "run's points are given";
    }
    std::string operator()(const PerturbedRunCut& w) const {
        return fmt::format(
            "the perturbed run ended at tau = {:.6g}, before the run itself: {}", w.tau,
            w.stopped ? "it was stopped from outside" : "by max_impacts");
    }
    std::string operator()(const NoDistanceSlope& w) const {
        return fmt::format(
            "the distance of the perturbed run has no slope: it is within {:.0f} % of its linear "
            "prediction up to tau = {:.6g} only, over {} impacts; at least {} are needed",
            100 * linear_share, w.linear_until, w.impacts, fewest_linear_impacts);
    }
};

}  // namespace

std::string text_of(const Warning& warning, std::size_t most_bytes) {
    return std::visit(Sentence{most_bytes}, warning);
}

std::string limit_of(std::size_t bytes) {
    return fmt::format(
        ", so that the answer is no larger than this server's limit of {} bytes", bytes);
}

}  // namespace vines::api
