// Hum of the mains in a record: a line of constant frequency near 50 or 60 Hz. Its kinks would be
// taken for impacts.
#pragma once

#include <vector>

#include "core/measurement/measured_record.hpp"

namespace vines {

struct Hum {
    double Omega, amplitude;  ///< amplitude in the unit of the channel
    bool in_displacement;
};

/// Removes lines within .3 % of the given frequencies from both channels if they exceed twice the
/// noise and are far above their neighbourhood. Returns them.
std::vector<Hum> remove_hum(MeasuredRecord& record, const std::vector<double>& mains);

}  // namespace vines
