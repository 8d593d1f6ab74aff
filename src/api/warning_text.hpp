// The core's warnings as sentences.
#pragma once

#include <string>
#include <vector>

#include "core/analysis/warning.hpp"

namespace vines::api {

using Warnings = std::vector<std::string>;

/// `most_bytes`: the server's limit of an answer, by which lists are cut.
std::string text_of(const Warning& warning, std::size_t most_bytes);

/// Why something is cut: the end of a sentence.
std::string limit_of(std::size_t bytes);

}  // namespace vines::api
