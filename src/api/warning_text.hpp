// Warnings and findings of the core as sentences.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "core/analysis/analysis.hpp"
#include "core/measurement/measurement.hpp"

namespace vines::api {

using Warnings = std::vector<std::string>;

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
