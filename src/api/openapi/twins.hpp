// The keys in SI that stand beside those in units of tau, by the table that answers are made by.
#pragma once

#include "api/schema/json.hpp"

namespace vines::api::document {

/// The schema of a part as add_si() leaves it; that of `energy` as add_joules() does, too.
Json with_si(Json schema);
Json with_joules(Json schema);

}  // namespace vines::api::document
