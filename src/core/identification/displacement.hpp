// Odd samples of a measured displacement.
#pragma once

#include "core/identification/measured_record.hpp"

namespace vines {

/// Single samples of the displacement that are far off are replaced by the cubic through their
/// neighbours. `jump`: the typical one of x' at an impact, whose kink is not odd.
void mend_displacement(MeasuredRecord& record, double jump);

}  // namespace vines
