// Results of the core as parts of an answer, and its warnings and findings as sentences. Nothing is
// computed here. A number that does not exist is null; a word in `status` gives the reason.
#pragma once

#include <limits>

#include "api/system.hpp"
#include "core/analysis/analysis.hpp"
#include "core/analysis/perturbation.hpp"
#include "core/measurement/measurement.hpp"

namespace vines::api {

/// The resolved parameters of a system, those of its run, and quantities derived from the former.
Json describe_system(const System& system, const Json& of_run = Json::object());

/// {impact, stroboscopic}.
Json describe_sections(const Sections& sections);

/// Expects a result that includes the oscillator without absorber.
Json describe_energy(const EnergyResult& energy);
Json describe_manifold(const Manifold& manifold);
Json describe_manifold(const ManifoldResult& manifold);

/// Exponents and verdict of one window, by the estimators in `shown`; with their histories if
/// `histories`. `regime` gives the reasons of the verdict.
Json describe_exponents(
    const WindowExponents& window, const ExponentOptions& shown, const Regime& regime,
    bool histories);
/// The result of each estimator, a part of describe_exponents(), with its slope if `slopes`.
void add_estimators(
    Json& part, const TransferProduct& product, const Growth& growth, const ExponentOptions& shown,
    bool histories, bool slopes);

Json describe_perturbation(Perturbation&& perturbation);

/// Type, impacts per cycle, periodic orbit and capture; null where a part does not exist.
Json describe_regime(const Regime& regime);

/// Floquet multipliers, by descending modulus.
Json describe_multipliers(const std::array<std::complex<double>, 4>& multipliers);

// Sentences (warning_text.cpp).

/// No limit on the size of an answer.
inline constexpr std::size_t any_size = std::numeric_limits<std::size_t>::max();

/// `most_bytes`: the size limit of an answer, by which lists are cut.
std::string text_of(const Warning& warning, std::size_t most_bytes);

/// The end of a sentence: the size limit as the reason for a cut.
std::string limit_of(std::size_t bytes);

/// The reason why an impact is left out; empty for none.
const char* text_of(ImpactFault fault);
/// The reason why no b is fitted; empty for none.
const char* text_of(BFault fault);
/// The reason why a measurement allows no verdict.
const char* text_of(Doubt doubt);

}  // namespace vines::api
