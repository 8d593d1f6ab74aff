// State of the search for impacts, and its stages (search.cpp holds their order):
//
//     fits      search.cpp         motion, pulses, oscillator, mass
//     review    search_review.cpp  false candidates, overlooked impacts, predicted contacts
#pragma once

#include <optional>

#include "core/measurement/candidates.hpp"

namespace vines {

struct ImpactSearch : ImpactSearchInput {
    FixedUnknowns fixed = measurement.fixed;
    UnknownValues values = given_unknowns(parameters);  ///< initial values of the next fit
    std::vector<Candidate> candidates = {};
    bool candidates_changed = true;  ///< since the last fit
    std::vector<Candidate> rejected = {};
    SpoiledExtents spoiled = {};
    bool may_release_oscillator = true;
    /// Set while the displacement is fitted alone: a record without the acceleration.
    std::optional<MeasuredRecord> displacement = {};
    UnknownValues mass_values = {};  ///< b and R from the last fit with the mass, converged or not
    int rounds = 0, hidden_rounds = 0;
    FoundImpacts found = {};
};

std::ptrdiff_t impact_count(const ImpactSearch& s);
bool is_in_gap(const ImpactSearch& s, double tau);

/// Fits the motion, continuing from the last fit if the impacts are the same; its times and values
/// are the next fit's initial ones. Then determines extent and shape of the pulses and the impact
/// times according to them.
void fit_motion_and_pulses(ImpactSearch& s);

/// Repeats fit_motion_and_pulses(), drops false candidates and adds overlooked impacts until
/// neither occurs.
void fit_until_settled(ImpactSearch& s, int least_rounds);

/// Adds hidden contacts predicted by a run of the identified system: weak impacts and sticking
/// phases. Drops the candidates that the fit put in their place. Returns whether anything changed.
bool add_hidden_contacts(ImpactSearch& s);

}  // namespace vines
