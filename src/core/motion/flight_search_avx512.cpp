#define vines_vector_width 8
#include "core/motion/flight_search.inl"

vines::NamedBatchSearch vines::avx512_search() { return {"AVX-512", search_batch}; }
