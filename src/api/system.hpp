// Builds the system and the initial state from a request's fields: merged over those of the preset
// that it names (merged_fields.cpp), checked and completed (system.cpp), and resolved to the core's
// parameters (system_fields.cpp), the last also for each point of a sweep.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "api/answer_json.hpp"
#include "api/problem.hpp"
#include "api/schema/tables.hpp"
#include "core/motion/load.hpp"
#include "core/motion/parameters.hpp"

namespace vines::api {

inline constexpr double standard_gravity = 9.80665;  ///< m/s^2

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

/// A table of R: the field restitution, restitution_plus or restitution_minus.
struct RestitutionField {
    RestitutionTable table;
    bool in_si = false;  ///< its speeds are in m/s
};

/// The field forcing, whose load depends on the oscillator. Keeps the last load: the points of most
/// sweeps share it.
class ForcingField {
public:
    explicit ForcingField(Json given) : given_(std::move(given)) {}
    /// Expects sub-fields that are valid by themselves. Problem 422 for an invalid load.
    std::shared_ptr<const Load> load(const SiParameters& si) const;
    /// The same without making it, which takes up to a tenth of a second.
    void check(const SiParameters& si) const;
    /// Memory of the load, about, also of an invalid one. f0: of the oscillator, Hz.
    std::size_t bytes(double f0) const;

private:
    const Json given_;
    mutable std::mutex mutex_;
    mutable std::shared_ptr<const Load> last_;
    mutable double omega0_ = 0, k1_ = 0;  // of last_
};

/// The fields of a request that define a system and its start.
struct SystemFields {
    std::map<std::string, double> numbers = {};  ///< those given, by name
    std::shared_ptr<const ForcingField> forcing = nullptr;
    std::optional<RestitutionField> restitution = {}, restitution_plus = {}, restitution_minus = {};
    Damping damping = Damping::equation_of_motion;

    bool has(const std::string& name) const { return numbers.contains(name); }
    bool has_any(const std::vector<std::string>& names) const;
    /// The number of this name; `fallback` if it is not given.
    double number(const std::string& name, double fallback = 0) const;
    bool is_reduced() const { return has_any(reduced_names); }
    bool is_in_si() const { return has_any(si_names); }
};

/// Reads checked fields of a request; ignores others.
SystemFields system_fields(const Json& fields);

/// A system in SI; omitted values are those of Table 1, or follow from the rest in the case of F
/// and f.
SiParameters si_of(const SystemFields& fields);

struct ResolvedSystem {
    Parameters parameters;
    std::optional<SiParameters> si;  ///< if the fields are in SI
};
/// Omitted values are those of Table 1. Does not check the core's ranges. Problem 422 for an
/// invalid load; a load needs a system in SI. Without makes_load it is only checked.
ResolvedSystem resolve(const SystemFields& fields, bool makes_load = true);

/// Velocities in m/s apply if the system is in SI.
State start_of(const SystemFields& fields, const ResolvedSystem& system);

using Warnings = std::vector<std::string>;  ///< sentences

/// The system of a request, in SI if the request or its preset is.
struct System : ResolvedSystem {
    /// Origin of each field: given, preset fig3, default, or the fields that it follows from.
    std::map<std::string, std::string> origin = {};
    Warnings notes = {};
    std::string load_kind = {};  ///< record, half_sine, chirp, noise or harmonics
};

/// A system with the default start. `forcing_fitted`: F can be omitted. Problem 422 for an
/// incomplete system in SI, and if the fields form no valid system.
System read_system_alone(const MergedFields& fields, bool forcing_fitted);

/// A system with its initial state.
struct StartedSystem {
    System system;
    State start;
    long max_impacts;
    std::vector<FieldError> errors;  ///< values that form no valid system; empty: valid
};
/// Problem 422 for fields that are missing, or that need a system in SI.
StartedSystem read_started_system(const MergedFields& fields, bool makes_load = true);
/// Reads sweep_base_fields(). Also Problem 422 for fields that are invalid by themselves or exclude
/// each other.
StartedSystem read_started_system(const Json& object, bool makes_load = true);
/// Why sweep_base_fields() form no valid system; empty if they do.
std::vector<FieldError> faults_of_base(const Json& object);

/// Index of the first number of a list that is not above its predecessor; the length if all are.
std::size_t first_not_ascending(const Json& list);

}  // namespace vines::api
