// The page's files as routes.
#pragma once

#include <string>
#include <vector>

#include "http/route.hpp"

namespace vines::http {

/// With a folder `web_dir` its files come from there, so that a change shows without a build; those
/// that it does not have (uPlot's lie elsewhere), and all without a folder, from the program.
std::vector<Route> page_routes(const std::string& web_dir);

}  // namespace vines::http
