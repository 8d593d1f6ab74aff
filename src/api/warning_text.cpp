#include <fmt/format.h>

#include "api/describe.hpp"

namespace vines::api {

namespace {

using namespace warning;

struct Sentence {
    std::size_t most_bytes;

    std::string operator()(const WindowNotReached& w) const {
        return fmt::format("the run had ended at tau = {:.6g}, before ", w.tau) +
               (w.count == 1 ? fmt::format("its window began at tau = {:.6g}", w.tau_start)
                             : fmt::format(
                                   "{} of its windows began, the first at tau = {:.6g}", w.count,
                                   w.tau_start));
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
    std::string operator()(const GrazingContact&) const {
        return "the ball touches a wall without an impact (tangent contact): neighbouring "
               "trajectories separate there";
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
        return w.rank == 2 ? "a sticking phase lies in the window: only deviations of the centre "
                             "of mass survive it, lambda3 and lambda4 are minus infinity"
                           : "an impact with R = 0, or a rest of the ball inside the cavity, "
                             "removes a deviation for good: lambda4 is minus infinity";
    }
    std::string operator()(const NearlyTangent& w) const {
        return fmt::format(
            "M is ill-conditioned at {} nearly tangent impact(s), most at tau = {:.6g}, whose "
            "relative speed is {:.2g} of the median: nearby motions miss this impact",
            w.count, w.tau, w.speed_ratio);
    }
    std::string operator()(const TransfersCut& w) const {
        return fmt::format(
            "eigenvalues and matrices are those of the last {} impacts (max_points) of {}", w.most,
            w.seen);
    }
    std::string operator()(const ModuliCut& w) const {
        return fmt::format(
            "eigenvalues are those of the last {} impacts: the time limit ended before those of "
            "the others were computed",
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
        return "the time limit ended the search for a periodic orbit: periodic is not decided";
    }
    std::string operator()(const CapturedTransient& w) const {
        return fmt::format(
            "a chaotic transient (lambda1 = {:.3g}) was captured by a periodic orbit {} (lambda1 = "
            "{:.3g}): {}",
            w.before, w.tau ? fmt::format("at tau = {:.1f}", *w.tau) : "after the run's end",
            w.after,
            w.in_run ? "exponents of a window that contains the capture average both"
                     : "the run is a part of the transient");
    }
    std::string operator()(const NotStationary& w) const {
        std::string text = "standard errors do not cover: ";
        if (w.lambda1 || w.x_rms)
            text += fmt::format(
                "{}{}{} differs between the halves of the window by more than chance permits",
                w.lambda1 ? "lambda1" : "", w.lambda1 && w.x_rms ? " and " : "",
                w.x_rms ? "x_rms" : "");
        if (w.conservative)
            text += std::string(w.lambda1 || w.x_rms ? "; " : "") +
                    "without dissipation (zeta = 0, R = 1) the energy drifts for ever";
        return text;
    }
    std::string operator()(const NoManifold&) const {
        return "the manifold of two symmetric impacts needs a harmonic forcing, one constant R, "
               "and "
               "no gravity or friction of the ball: only the run's points are given";
    }
    std::string operator()(const PerturbedRunCut& w) const {
        return fmt::format(
            "the perturbed run ended at tau = {:.6g}, before the run itself: {}", w.tau,
            w.stopped ? "it was stopped from outside"
                      : fmt::format(
                            "by max_impacts, or the {} impacts that are compared at most",
                            most_compared / 2));
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

const char* text_of(ImpactFault fault) {
    switch (fault) {
        case ImpactFault::none: return "";
        case ImpactFault::too_close:
            return "closer to the previous impact than a pulse is long: one spike picked twice?";
        case ImpactFault::moves_away:
            return "the ball would move away from the wall that it hits: is a neighbouring impact "
                   "missing, or b wrong?";
        case ImpactFault::no_velocity: return "too few samples around it for a velocity";
        case ImpactFault::R_impossible:
            return "R lies outside [0, 1]: is a neighbouring impact missing, or b wrong?";
        case ImpactFault::momentum_lost:
            return "momentum is not conserved: is a neighbour missing or false, or b wrong?";
    }
    return "";
}

const char* text_of(BFault fault) {
    switch (fault) {
        case BFault::none: return "";
        case BFault::no_flight: return "no impact is next to one on the other wall";
        case BFault::negative: return "it would be negative";
        case BFault::scattered: return "the impacts give different values";
        case BFault::doubtful:
            return "the impacts or the model are doubtful, and R is withheld, too";
    }
    return "";
}

const char* text_of(Doubt doubt) {
    switch (doubt) {
        case Doubt::not_settled:
            return "the search for impacts did not converge: one round finds impacts that the next "
                   "one drops";
        case Doubt::unexplained:
            return "the fitted motion does not explain the record: the residual exceeds the noise "
                   "of the sensors (signal.misfit). Are impacts hidden, is a fixed value wrong, or "
                   "does a sensor have errors other than offset, drift, delay and scale?";
        case Doubt::pulses_disagree:
            return "many pulses are not at impacts, and equally many impacts have no pulse: does "
                   "the ball stick to a wall in each cycle?";
        case Doubt::impacts_differ:
            return "R or the balance of momentum differs from impact to impact: does the ball "
                   "stick to a wall in each cycle, or is m2 or b wrong?";
        case Doubt::hidden_uncertain:
            return "the impacts that are too weak to be seen do not explain the record: their "
                   "number and times are uncertain";
        case Doubt::b_disagrees: return "the impacts' momentum does not fit the given b";
        case Doubt::no_forcing:
            return "no forcing at this frequency leads from each impact of the list to the next";
    }
    return "";
}

}  // namespace vines::api
