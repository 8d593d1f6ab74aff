// Contacts that a measurement does not show between two impacts: those too weak to be seen, the end
// of a chatter, the sticking phase after it, or an impact missing from a list. If a run of the
// identified system from the first impact reaches the second, it has the hidden contacts.
#pragma once

#include <initializer_list>
#include <optional>
#include <vector>

#include "core/measurement/identified_impact.hpp"
#include "core/measurement/interval_motion.hpp"
#include "core/measurement/measured_record.hpp"
#include "core/motion/record.hpp"

namespace vines {

/// The identified system, prepared for runs from any time of the measurement.
struct IdentifiedSystem {
    /// `parameters`: with the identified b, R of each wall and Omega. `values`: forcing (phase at
    /// `tau_zero`), stiffness and damping. `load`: null if the forcing is a sine.
    IdentifiedSystem(
        const Parameters& parameters, const UnknownValues& values, double tau_zero,
        const MeasuredLoad* load);
    /// The system of a list of impacts, with the given oscillator.
    IdentifiedSystem(const Parameters& parameters, const ListedForcing& forcing);

    /// Runs from `tau` on; `state` and `limits` in the measurement's units. Observers see the run's
    /// own time, which starts at start_of(tau) and runs `faster`.
    Outcome run(
        double tau, const State& state, Limits limits,
        std::initializer_list<Observer*> observers) const;
    double start_of(double tau) const;

    /// Motion of the oscillator at `tau` while the mass flies between two walls, from a state.
    OscillatorMotion free_motion(const Release& from, int from_side, double tau, int to_side) const;
    /// Converts an impact of a run from `tau` on to the measurement's units.
    Impact measured(Impact impact, double tau) const;
    /// The measurement's tau at `own_tau` of a run from `tau` on.
    double measured_time(double own_tau, double tau) const {
        return (own_tau - start_of(tau)) / faster + tau;
    }

    const UnknownValues values;
    const IntervalFlows flows;
    Parameters own;  ///< in the run's own time
    double faster;   ///< units of the run's own time per unit of tau
    double tau_zero;
};

/// An impact of a run, in the measurement's units.
struct RunImpact : IdentifiedImpact {
    std::optional<std::size_t> shown = {};  ///< index of the measured impact; none: hidden
};

/// The contacts between the measured impacts `from` and `to`, at least one of them hidden.
struct HiddenContacts {
    std::size_t from, to;
    double y_dot_after, y_dot_before;  ///< y' of the mass after `from` and before `to`
    /// end of the sticking phase, if the mass sticks after `from`
    std::optional<Release> release = {};
    std::vector<RunImpact> impacts = {};
};

/// Limits for the search of hidden contacts.
struct HiddenContactLimits {
    /// Tolerance in x and x' for reaching an impact.
    double tolerance = 0;
    double typical_flight = 0;  ///< tau; no run lasts longer than 40 of them
    /// Most consecutive hidden impacts that are strong enough to be visible.
    int most_seen = 6;
    std::vector<Interval> gaps = {};  ///< gaps of the record in order; no run crosses them
};
/// Hidden contacts in order of time. The velocity of the mass after an impact comes from the flight
/// before it, eq. (43), or from the impact's own jump, eqs. (4), (36). `doubtful`: one entry per
/// impact, nonzero if it can be an artefact of hidden contacts nearby; empty: all are certain.
std::vector<HiddenContacts> hidden_contacts(
    const IdentifiedSystem& system, const HiddenContactLimits& limits,
    const IdentifiedImpacts& impacts, const std::vector<char>& doubtful = {},
    const Look& look = [] {});

/// Inserts the hidden contacts (found without doubtful impacts) and takes the velocities of the
/// mass there from the run.
void insert_hidden(const std::vector<HiddenContacts>& hidden, IdentifiedImpacts& impacts);

}  // namespace vines
