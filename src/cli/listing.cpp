#include "cli/listing.hpp"

#include "api/problem.hpp"

namespace vines::cli {

void add_listing(CLI::App& command, Listing& listing, const std::string& about) {
    command.add_option("name", listing.name, about);
    command
        .add_option(
            "--format", listing.format, "text; or json: what the service answers, always of all")
        ->check(CLI::IsMember({"text", "json"}))
        ->capture_default_str();
}

void refuse_name(const std::string& kind, const std::string& name, const std::string& meant) {
    throw api::Problem(
        422, "no " + kind + " has the name " + api::shortened(name) +
                 (meant.empty() ? "" : "; did you mean " + meant + "?"));
}

}  // namespace vines::cli
