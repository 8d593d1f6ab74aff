#define vines_vector_width 2
#include "core/motion/flight_search.inl"

vines::NamedBatchSearch vines::baseline_search() { return {"baseline", search_batch}; }
