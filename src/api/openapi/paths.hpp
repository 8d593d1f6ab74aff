// The operations of the document.
#pragma once

#include "api/schema/json.hpp"

namespace vines::api::document {

Json paths();
Json tags();
/// components/parameters.
Json parameter_components();

}  // namespace vines::api::document
