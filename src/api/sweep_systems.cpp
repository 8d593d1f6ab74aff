#include "api/sweep_systems.hpp"

#include "api/schema/tables.hpp"

namespace vines::api {

SweepSystems::SweepSystems(
    std::vector<SystemFields> bases, std::vector<Axis> axes, long max_impacts)
    : bases_(std::move(bases)),
      max_impacts_(max_impacts) {
    for (Axis& axis : axes) {
        const Range range = *find(sweep_base_fields(), axis.parameter)->range;
        columns_.push_back(
            {system_number(axis.parameter), std::move(axis.values), range.minimum, range.maximum});
    }
}

SystemFields SweepSystems::fields_at(const Place& place) const {
    SystemFields fields = bases_[place.start];
    for (std::size_t a = 0; a < columns_.size(); ++a)
        fields.*columns_[a].number = columns_[a].values[place.at[a]];
    return fields;
}

std::optional<PointSystem> SweepSystems::at(const Place& place) const {
    for (std::size_t a = 0; a < columns_.size(); ++a) {
        const double value = columns_[a].values[place.at[a]];
        if (!(value >= columns_[a].minimum && value <= columns_[a].maximum)) return std::nullopt;
    }
    const SystemFields fields = fields_at(place);
    // Only where nothing is forced the frequency may be left out.
    if (fields.is_in_si() && !fields.is_reduced() && !fields.f && fields.F != 0.0)
        return std::nullopt;
    const ResolvedSystem system = resolve(fields);
    const State start = start_of(fields, system);
    if (!validate(system.parameters, start).empty()) return std::nullopt;
    return PointSystem{system.parameters, start, max_impacts_};
}

std::optional<SiParameters> SweepSystems::si_at(const Place& place) const {
    return resolve(fields_at(place)).si;
}

}  // namespace vines::api
