#define vines_vector_width 4
#include "core/motion/flight_search.inl"

vines::NamedBatchSearch vines::avx2_search() { return {"AVX2", search_batch}; }
