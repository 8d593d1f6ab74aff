// Results of the core as the parts of an answer, beside exponents and regime. Nothing is computed
// here.
#pragma once

#include <optional>

#include "api/request.hpp"
#include "core/sweep/recommend.hpp"

namespace vines::api {

/// The resolved parameters of a system without what belongs to a run, and what follows from them.
Json describe_system(const System& system);
Json describe_derived(const System& system);

Json describe_series(Series&& series);
/// `typical_speed`: what relative_speed_ratio is measured by.
Json describe_impacts(const std::vector<Impact>& impacts, double epsilon, double typical_speed);
Json describe_sticks(const std::vector<StuckPhase>& sticks);
Json describe_touches(const std::vector<TangentContact>& touches);

Json describe_moduli(const TransferModuli& moduli);
Json describe_matrices(const TransferMatrices& matrices);

Json describe_sections(const Sections& sections);
Json describe_impact_section(const std::vector<SectionPoint>& points);
Json describe_states(const std::vector<State>& states);

/// Of a result with the oscillator alone beside it.
Json describe_energy(const EnergyResult& energy);
Json describe_manifold(const Manifold& manifold);
Json describe_manifold(const ManifoldResult& manifold);
/// Null where there is none.
Json describe_recommendation(const std::optional<Recommendation>& recommendation);

}  // namespace vines::api
