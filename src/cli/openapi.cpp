// `vines openapi`: the document that the service has at /v1/openapi.json.
#include "api/openapi/openapi.hpp"

#include "cli/commands.hpp"
#include "cli/stop_signals.hpp"
#include "program/examples.hpp"
#include "program/print.hpp"

namespace vines::cli {

Command add_openapi(CLI::App& app) {
    CLI::App* command = app.add_subcommand("openapi", "the OpenAPI document");
    add_examples(*command, "vines openapi | jq '.paths | keys'");
    return ended_by_signals({command, [] {
                                 print(api::openapi().dump(2) + "\n");
                                 return 0;
                             }});
}

}  // namespace vines::cli
