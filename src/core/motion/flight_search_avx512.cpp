#define vines_lanes 8
#include "core/motion/flight_search.inl"

vines::NamedSearch vines::avx512_search() { return {"AVX-512", search_lanes}; }
