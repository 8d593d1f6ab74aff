// The page's files as routes.
#pragma once

#include <string>
#include <vector>

#include "http/route.hpp"

namespace vines::http {

/// Those compiled in; with a folder `web_dir` its scripts, style sheets and drawings as they are
/// there, so that a change shows without a build.
std::vector<Route> page_routes(const std::string& web_dir);

}  // namespace vines::http
