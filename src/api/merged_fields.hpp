// A request's fields, merged over those of the preset that it names.
#pragma once

#include "api/answer_json.hpp"
#include "api/schema/tables.hpp"
#include "api/system_fields.hpp"

namespace vines::api {

/// A request's fields, each checked by itself, over those of its preset.
struct MergedFields {
    const FieldTable& table;  ///< outlives the request, like the tables of tables.hpp
    Json given;
    Json fields;         ///< given, and those added by the preset
    std::string preset;  ///< empty: none
    Json dropped;        ///< fields of the preset that do not apply to another system or run

    /// "given", "preset NAME" or "default".
    std::string origin(const std::string& name) const;

    bool has(const std::string& name) const { return fields.contains(name); }
    /// The value: from the request, else the preset, else the table's default.
    const Json& operator[](const std::string& name) const;
};

/// A given field replaces only the same value of the preset. But a preset's damping applies only to
/// its own masses, spring and damper, and its windows only to its own motion; both are dropped if
/// the request changes these. Problem 422 for an invalid field.
MergedFields merge_with_preset(const FieldTable& table, const Json& given);

/// epsilon, lambda, G, Omega.
extern const std::vector<std::string> reduced_names;
/// One field of each group makes a system in SI; the second of a group can replace the first.
extern const std::vector<std::vector<std::string>> si_groups;
/// All fields of si_groups.
extern const std::vector<std::string> si_names;

/// The names that an object has.
std::vector<std::string> present(const Json& object, const std::vector<std::string>& names);

}  // namespace vines::api
