// State of the search for impacts, and its stages (search.cpp holds their order):
//
//     fits      search_fit.cpp     motion, pulses, oscillator, mass
//     review    search_review.cpp  false candidates, overlooked impacts
//     hidden    search_hidden.cpp  contacts that a run of the identified system predicts
#pragma once

#include <functional>

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

struct ImpactSearchState {
    FixedUnknowns fixed;
    UnknownValues values;  ///< initial values of the next fit
    std::vector<Candidate> candidates = {};
    bool candidates_changed = true;  ///< since the last fit
    std::vector<RejectedCandidate> rejected = {};
    SpoiledExtents spoiled = {};
    bool may_free_oscillator = true;
    Sides sides = {};                ///< walls of the candidates
    UnknownValues mass_values = {};  ///< b and R from the last fit with the mass, converged or not
    int rounds = 0, hidden_rounds = 0;
    FoundImpacts found = {};
};

std::ptrdiff_t impact_count(const ImpactSearchState& state);
bool is_in_gap(const ImpactSearchState& state, double tau);

/// Input of a joint fit of the candidates to a record, or to one of its channels.
JointFitInput fit_input(
    const ImpactSearchInput& in, const ImpactSearchState& state, const MeasuredRecord& record);
/// Impact times of a fit: according to the events, or to the pulse template.
std::vector<ImpactTime> event_times(const ImpactSearchInput& in, const ImpactSearchState& state);
std::vector<ImpactTime> pulse_times(const ImpactSearchState& state);

/// Continues from the last fit if the impacts are the same; its times and values are the next fit's
/// initial ones.
void fit_motion(
    const ImpactSearchInput& in, ImpactSearchState& state, const MeasuredRecord& record,
    const std::vector<ImpactTime>& times);
/// Fits the motion, then determines extent and shape of the pulses and the impact times according
/// to them.
void fit_motion_and_pulses(const ImpactSearchInput& in, ImpactSearchState& state);
/// Limits the extent of pulses to a fraction of a typical flight.
void limit_pulse_extent(ImpactSearchState& state);
/// Frees stiffness and damping if the record contradicts the given values; returns whether it does.
bool free_oscillator(
    const ImpactSearchInput& in, ImpactSearchState& state, const MeasuredRecord& record,
    const std::vector<ImpactTime>& times);
/// Returns to the given oscillator if the fitted one is implausible, which indicates another
/// problem; returns whether it is.
bool restore_given_oscillator(const ImpactSearchInput& in, ImpactSearchState& state);
void assign_walls(ImpactSearchState& state);
/// Fits with the mass: once the impacts are known it refines their times, R and b.
void fit_with_mass(const ImpactSearchInput& in, ImpactSearchState& state);

/// Repeats `refit`, drops false candidates and adds overlooked impacts until neither occurs.
void fit_until_settled(
    const ImpactSearchInput& in, ImpactSearchState& state, const std::function<void()>& refit,
    int least_rounds);

/// Adds hidden contacts predicted by a run of the identified system: weak impacts and sticking
/// phases. Drops the candidates that the fit put in their place. Returns whether anything changed.
bool add_hidden_contacts(const ImpactSearchInput& in, ImpactSearchState& state);

}  // namespace vines
