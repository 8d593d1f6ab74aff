// What the core says of a measurement, as sentences.
#pragma once

#include "core/measurement/identify.hpp"

namespace vines::api {

/// Why an impact is left out; empty for none.
const char* text_of(ImpactFault fault);
/// Why no b is fitted; empty for none.
const char* text_of(BFault fault);
/// Why no verdict can rest on a record.
const char* text_of(Doubt doubt);

}  // namespace vines::api
