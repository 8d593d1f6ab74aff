#define vines_lanes 2
#include "core/motion/flight_search.inl"

vines::NamedSearch vines::baseline_search() { return {"baseline", search_lanes}; }
