// The systems of a sweep's points: the request is read once, each point is arithmetic.
#pragma once

#include <optional>
#include <vector>

#include "api/sweep_axis.hpp"
#include "api/system_fields.hpp"
#include "core/sweep/sweep.hpp"

namespace vines::api {

class SweepSystems {
public:
    /// `bases`: for each start the fields of a point with it, each checked, over those of their
    /// preset; the axes' own are replaced.
    SweepSystems(std::vector<SystemFields> bases, std::vector<Axis> axes, long max_impacts);

    /// None where the values of the point are out of their ranges or make no valid system.
    std::optional<PointSystem> at(const Place& place) const;
    /// The same system in SI, where its fields are.
    std::optional<SiParameters> si_at(const Place& place) const;

private:
    struct Column {
        SystemNumber number;
        std::vector<double> values;
        double minimum, maximum;
    };
    SystemFields fields_at(const Place& place) const;

    std::vector<SystemFields> bases_;
    std::vector<Column> columns_;
    long max_impacts_;
};

}  // namespace vines::api
