// Contacts that a measurement does not show between two impacts that it shows: impacts too weak to
// be seen, the end of a chatter, the sticking phase after it, or an impact missing from a list. The
// identified system is run from the first of the two impacts; if the run reaches the second one,
// the contacts between them are the hidden ones.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "core/measurement/identified_impact.hpp"
#include "core/measurement/interval_motion.hpp"
#include "core/measurement/measured_record.hpp"
#include "core/motion/record.hpp"

namespace vines {

/// The identified system, prepared for runs from any time of the measurement.
class IdentifiedSystem {
public:
    /// `parameters`: with the identified b, R of each wall and Omega. `values`: forcing (phase at
    /// `tau_zero`), stiffness and damping.
    IdentifiedSystem(const Parameters& parameters, const UnknownValues& values, double tau_zero);

    /// Runs from `tau` on; `state` and `limits` in the measurement's units. Observers see the run's
    /// own time, which starts at start_of(tau) and runs faster by faster().
    Outcome run(
        double tau, const State& state, Limits limits, std::span<Observer* const> observers) const;
    double start_of(double tau) const;
    double faster() const { return faster_; }

    /// Motion of the oscillator at `tau` while the mass flies between two walls, from a state.
    OscillatorMotion free_motion(const Release& from, int from_side, double tau, int to_side) const;
    /// Converts an impact of a run from `tau` on to the measurement's units.
    Impact measured(Impact impact, double tau) const;
    /// The measurement's tau at `own_tau` of a run from `tau` on.
    double measured_time(double own_tau, double tau) const {
        return (own_tau - start_of(tau)) / faster_ + tau;
    }
    const Parameters& own() const { return own_; }

private:
    const UnknownValues values_;
    const OscillatorFlows flows_;
    Parameters own_;
    double faster_, phase_, tau_zero_;
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
    /// Most consecutive hidden impacts that are strong enough to be visible: a list or a search can
    /// miss some.
    int most_seen = 6;
    std::vector<TimeGap> gaps = {};  ///< gaps of the record in order; no run crosses them
};
/// Hidden contacts in order of time. The velocity of the mass after an impact comes from the flight
/// before it, eq. (43), or from the impact's own jump, eqs. (4), (36). `doubtful`: one entry per
/// impact, nonzero if it can be an artefact of hidden contacts nearby; empty: all are certain.
/// look() is called for each impact; an exception it throws passes through.
std::vector<HiddenContacts> hidden_contacts(
    const IdentifiedSystem& system, const HiddenContactLimits& limits,
    const std::vector<IdentifiedImpact>& impacts, const std::vector<char>& doubtful = {},
    const std::function<void()>& look = [] {});

/// Inserts the hidden contacts (found without doubtful impacts) and takes the velocities of the
/// mass there from the run. Returns the number of impacts added.
long insert_hidden(
    const std::vector<HiddenContacts>& hidden, std::vector<IdentifiedImpact>& impacts);

}  // namespace vines
