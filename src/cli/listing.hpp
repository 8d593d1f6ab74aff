// What the commands have in common that list what can be asked for.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vines::cli {

struct Listing {
    std::string name;  ///< empty: all
    std::string format = "text";

    bool is_json() const { return format == "json"; }
};

/// about: of the name.
void add_listing(CLI::App& command, Listing& listing, const std::string& about);

/// Problem 422 for a name that nothing has; meant: what is near, if anything.
[[noreturn]] void refuse_name(
    const std::string& kind, const std::string& name, const std::string& meant);

}  // namespace vines::cli
