// `vines openapi`: the document that the service has at /v1/openapi.json.
#include "api/openapi/openapi.hpp"

#include <cstdio>

#include "cli/commands.hpp"

namespace vines::cli {

Command add_openapi(CLI::App& app) {
    return {app.add_subcommand("openapi", "write the OpenAPI document to stdout"), [] {
                return std::puts(api::openapi().dump(2).c_str()) < 0 ? 1 : 0;
            }};
}

}  // namespace vines::cli
