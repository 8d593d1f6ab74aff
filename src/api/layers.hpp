// A request's fields over those of the preset that it names.
#pragma once

#include <set>

#include "api/schema/tables.hpp"
#include "api/system_fields.hpp"
#include "core/motion/simulate.hpp"

namespace vines::api {

/// A request's fields, each checked by itself, over those of its preset.
struct Layered {
    const FieldTable& table;  ///< outlives the request, as those of tables.hpp do
    Json given;
    Json fields;         ///< given, and what the preset adds
    std::string preset;  ///< empty: none
    Json left;           ///< of the preset's fields those that went with its own system or run

    /// given, preset NAME or default.
    std::string origin(const std::string& name) const;

    bool has(const std::string& name) const { return fields.contains(name); }
    /// Values by name: the request's or the preset's, else the table's default.
    double number(const std::string& name) const;
    double number(const std::string& name, double fallback) const {
        return has(name) ? number(name) : fallback;
    }
    std::string word(const std::string& name) const;
    std::set<std::string> words(const std::string& name) const;
    Interval interval(const std::string& name) const;
    std::vector<Interval> intervals(const std::string& name) const;
};

/// A field that is given replaces its own value of the preset alone. But a preset's damping is that
/// of its own masses, spring and damper, and its windows are those of its own motion: they go with
/// them. Problem 422 where a field is at fault.
Layered layered(const FieldTable& table, const Json& given);

/// epsilon, lambda, G, Omega.
extern const std::vector<std::string> reduced_names;
/// One of each line makes a system in SI; the second of a line is what engineers say in place of
/// the first.
extern const std::vector<std::vector<std::string>> si_lines;
/// All of them.
extern const std::vector<std::string> si_names;

/// Those of the names that an object has.
std::vector<std::string> present(const Json& object, const std::vector<std::string>& names);

/// m1, c1, k1, m2, F, f.
Json fields_of(const SiParameters& si);

}  // namespace vines::api
