// Results of the core as the parts of an answer: columns, and null with a word beside it for a
// number that does not exist.
#pragma once

#include <span>

#include "api/request.hpp"
#include "core/measures/energy.hpp"
#include "core/measures/manifold.hpp"
#include "core/measures/regime.hpp"
#include "core/sweep/recommend.hpp"

namespace vines::api {

using Warnings = std::vector<std::string>;

Json finite_or_null(double value);
/// The words of the answers.
const char* word(Status status);
/// Null where there is nothing to judge.
Json word(Verdict verdict);
/// A number for people: with printf's format.
std::string digits(const char* format, double value);

/// The resolved parameters of a system without what belongs to a run, and what follows from them.
Json describe_system(const System& system);
Json describe_derived(const System& system);

Json describe_series(SeriesRecord&& series);
/// `typical_speed`: what relative_speed_ratio is measured by.
Json describe_impacts(const std::vector<Impact>& impacts, double epsilon, double typical_speed);
Json describe_sticks(const std::vector<StickRecord::Stick>& sticks);
Json describe_touches(const std::vector<TouchRecord::Touch>& touches);

/// The exponents of one window of a run of this regime. `histories` adds those of each estimator,
/// and warnings are about it then.
Json describe_exponents(
    const TransferProduct& product, const Growth& growth, const ExponentOptions& estimators,
    const Regime& regime, bool histories, Warnings& warnings);

/// Moduli of the eigenvalues of J, M, T at each impact, and the matrices themselves. Those of T
/// take their time: once `late`, only the last impacts have them, and a warning says so.
Json describe_eigenvalues(
    std::span<const ImpactTransfer> transfers, const std::function<bool()>& late,
    Warnings& warnings);
Json describe_matrices(const std::vector<ImpactTransfer>& transfers);

/// Sections at impact and at whole forcing cycles: the last `most` points of each that lie in the
/// window.
Json describe_section(
    SectionRecord& impacts, const StroboscopicRecord& stroboscopic, const Interval& window,
    std::size_t most, Warnings& warnings);

/// The shares of the energy at the window's start that `decay` of describe_energy() is of.
inline const std::vector<double> decay_shares = {0.5, 0.1};
/// `window`: what of it the run has reached.
Json describe_energy(
    const Parameters& parameters, const State& start, const Energy& energy, const Decay& decay,
    const Interval& window);
/// Its moving z thinned to `most` entries, and the last `most` stretches.
Json describe_regime(Regime regime, std::size_t most, Warnings& warnings);

/// The manifold with `points` points on each branch that there is, up to V_max (0: twice the speed
/// of the symmetry breaking) or to where the motion ends.
Json describe_manifold(const Parameters& parameters, double V_max, std::size_t points);
/// Null where there is none.
Json describe_recommendation(const std::optional<Recommendation>& recommendation);

}  // namespace vines::api
