#define vines_lanes 4
#include "core/motion/flight_search.inl"

vines::NamedSearch vines::avx2_search() { return {"AVX2", search_lanes}; }
