// State of the search for impacts, and its stages (search.cpp holds their order):
//
//     fits      search_fit.cpp     motion, pulses, oscillator, mass
//     review    search_review.cpp  false candidates, overlooked impacts
//     hidden    search_hidden.cpp  contacts that a run of the identified system predicts
#pragma once

#include <optional>

#include "core/measurement/candidates.hpp"

namespace vines {

/// Time around an impact in which it spoils the samples.
struct SpoiledExtents {
    PulseExtent a{0, 0};  ///< in the acceleration
    double x = 0;         ///< in the displacement, on either side
};

struct RejectedCandidate {
    double tau;
    bool is_shown;  ///< visible as a pulse, or given
};

struct ImpactSearch : ImpactSearchInput {
    FixedUnknowns fixed = measurement.fixed;
    UnknownValues values = given_unknowns(parameters);  ///< initial values of the next fit
    std::vector<Candidate> candidates = {};
    bool candidates_changed = true;  ///< since the last fit
    std::vector<RejectedCandidate> rejected = {};
    SpoiledExtents spoiled = {};
    bool may_release_oscillator = true;
    /// Set while the displacement is fitted alone: a record without the acceleration.
    std::optional<MeasuredRecord> displacement = {};
    Sides sides = {};                ///< walls of the candidates
    UnknownValues mass_values = {};  ///< b and R from the last fit with the mass, converged or not
    int rounds = 0, hidden_rounds = 0;
    FoundImpacts found = {};
};

std::ptrdiff_t impact_count(const ImpactSearch& s);
bool is_in_gap(const ImpactSearch& s, double tau);

/// Input of a joint fit of the candidates.
JointFitInput fit_input(const ImpactSearch& s);
/// Impact times of a fit according to the pulses; for the displacement alone, to the events.
std::vector<ImpactTime> impact_times(const ImpactSearch& s);

/// Fits the motion, continuing from the last fit if the impacts are the same; its times and values
/// are the next fit's initial ones. Then determines extent and shape of the pulses and the impact
/// times according to them.
void fit_motion_and_pulses(ImpactSearch& s);
/// Limits the extent of pulses to a fraction of a typical flight.
void limit_pulse_extent(ImpactSearch& s);
/// Frees stiffness and damping if the record contradicts the given values; returns whether it does.
bool release_oscillator(ImpactSearch& s);
/// Returns to the given oscillator if the fitted one is implausible, which indicates another
/// problem; returns whether it is.
bool restore_given_oscillator(ImpactSearch& s);
void assign_walls(ImpactSearch& s);
/// Fits with the mass: once the impacts are known it refines their times, R and b.
void fit_with_mass(ImpactSearch& s);

/// Repeats fit_motion_and_pulses(), drops false candidates and adds overlooked impacts until
/// neither occurs.
void fit_until_settled(ImpactSearch& s, int least_rounds);

/// Adds hidden contacts predicted by a run of the identified system: weak impacts and sticking
/// phases. Drops the candidates that the fit put in their place. Returns whether anything changed.
bool add_hidden_contacts(ImpactSearch& s);

}  // namespace vines
