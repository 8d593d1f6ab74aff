#include "api/identify_text.hpp"

namespace vines::api {

const char* text_of(ImpactFault fault) {
    switch (fault) {
        case ImpactFault::none: return "";
        case ImpactFault::too_close:
            return "closer to the impact before it than the length of a pulse: one spike picked "
                   "twice?";
        case ImpactFault::moves_away:
            return "the mass would move away from the wall that it meets: is an impact beside it "
                   "missing, or b wrong?";
        case ImpactFault::no_velocity: return "too few samples beside it for a velocity";
        case ImpactFault::R_impossible:
            return "R lies outside [0, 1]: is an impact beside it missing, or b wrong?";
        case ImpactFault::momentum_lost:
            return "momentum is not kept: is an impact beside it missing or false, or b wrong?";
    }
    return "";
}

const char* text_of(BFault fault) {
    switch (fault) {
        case BFault::none: return "";
        case BFault::no_flight: return "no impact has one on the other wall before or after it";
        case BFault::negative: return "it would be negative";
        case BFault::scattered: return "the impacts say different ones";
    }
    return "";
}

const char* text_of(Doubt doubt) {
    switch (doubt) {
        case Doubt::not_settled:
            return "the search for impacts did not settle: what one round finds the next one drops";
        case Doubt::unexplained:
            return "the fitted motion does not explain the record: it leaves more than the noise "
                   "of the sensors (signal.misfit). Are impacts hidden, is something fixed "
                   "that is wrong, or does a sensor more than an offset, a drift, a delay and a "
                   "scale?";
        case Doubt::pulses_disagree:
            return "many pulses are not where impacts are found, and as many impacts have none: "
                   "does "
                   "the mass stick to a wall in each cycle?";
        case Doubt::impacts_differ:
            return "R or the balance of momentum differs from impact to impact: does the mass "
                   "stick "
                   "to a wall in each cycle, or is m2 or b wrong?";
        case Doubt::b_disagrees: return "the impacts' momentum does not fit the given b";
        case Doubt::no_forcing:
            return "no forcing at this frequency leads from each impact of the list to the next";
    }
    return "";
}

}  // namespace vines::api
