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

/// Columns of equal length; x and y in m, derivatives in tau.
Json describe_series(const Series& series);
Json describe_sticks(const std::vector<StuckPhase>& sticks);
Json describe_touches(const std::vector<TangentContact>& touches);

/// {tau, J, M, T, M_condition}: four moduli of each matrix, one entry for each impact.
Json describe_moduli(const TransferModuli& moduli);
/// {tau, order, J, M, T}: 4 x 4 matrices by rows, one of each for each impact.
Json describe_matrices(const TransferMatrices& matrices);

/// {impact, stroboscopic}, and each by itself: columns.
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
